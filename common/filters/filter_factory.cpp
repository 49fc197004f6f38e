#include "common/filters/filter_factory.hpp"

#include <array>

#include "common/filters/gauss_newton_orientation.hpp"

namespace limbcast::filters {
namespace {

using FilterResult = Result<std::unique_ptr<OrientationFilter>>;

template <typename Filter, typename Config>
FilterResult Make(std::string_view name, std::span<const SettingField<Config>> fields,
                  std::span<const Setting> settings, const Config& defaults = {}) {
  auto config = ConfigFromSettings<Config>(name, fields, settings, defaults);
  if (!config) {
    return config.error();
  }
  return std::unique_ptr<OrientationFilter>(std::make_unique<Filter>(*config));
}

constexpr std::array<std::string_view, 1> kNames = {"tqt"};

}  // namespace

std::span<const std::string_view> FilterNames() { return kNames; }

Result<std::unique_ptr<OrientationFilter>> MakeFilter(std::string_view name,
                                                      std::span<const Setting> settings) {
  if (name == "tqt") {
    return Make<GaussNewtonOrientation>(name, GaussNewtonFields(), settings);
  }
  return Error{ErrorCode::kInvalidArgument, "filter must be " + internal::ChoicesText(kNames) +
                                                ", is '" + std::string(name) + "'"};
}

}  // namespace limbcast::filters
