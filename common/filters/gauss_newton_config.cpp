#include "common/filters/gauss_newton_config.hpp"

#include <array>

namespace limbcast::filters {
namespace {

constexpr std::array<std::string_view, 2> kFormNames = {"reduced", "full"};
constexpr std::array<std::string_view, 3> kIntegrationNames = {"auto", "euler", "exponential"};
constexpr std::array<SettingField<GaussNewtonConfig>, 8> kFields = {
    Choice<&GaussNewtonConfig::form>("form", kFormNames),
    Choice<&GaussNewtonConfig::integration>("integration", kIntegrationNames),
    Choice<&GaussNewtonConfig::precision>("precision", kPrecisionNames),
    Number<&GaussNewtonConfig::k_per_s>("k_per_s", 0.0, 100.0),
    Number<&GaussNewtonConfig::rho>("rho", 0.0, 10.0),
    Number<&GaussNewtonConfig::null_time_s>("null_time_s", 0.0, 60.0),
    Whole<&GaussNewtonConfig::iterations>("iterations", 1.0, 20.0),
    Number<&GaussNewtonConfig::init_time_s>("init_time_s", 0.0, 10.0),
};

}  // namespace

std::span<const SettingField<GaussNewtonConfig>> GaussNewtonFields() { return kFields; }

Status Validate(const GaussNewtonConfig& config) {
  return ValidateFields<GaussNewtonConfig>("tqt", config, kFields);
}

}  // namespace limbcast::filters
