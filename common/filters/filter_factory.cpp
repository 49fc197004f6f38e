#include "common/filters/filter_factory.hpp"

#include <array>

#include "common/filters/bounded_motion_filter.hpp"
#include "common/filters/complementary_kalman.hpp"
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

constexpr std::array<std::string_view, 5> kNames = {"tqt", "ckf", "ckf-plain", "bmf", "bmf-plain"};

FilterResult MakeBoundedMotion(std::string_view name, std::span<const Setting> settings,
                               const BoundedMotionConfig& defaults) {
  auto config =
      ConfigFromSettings<BoundedMotionConfig>(name, BoundedMotionFields(), settings, defaults);
  if (!config) {
    return config.error();
  }
  return MakeBoundedMotionFilter(*config, name);
}

}  // namespace

std::span<const std::string_view> FilterNames() { return kNames; }

Result<std::unique_ptr<OrientationFilter>> MakeFilter(std::string_view name,
                                                      std::span<const Setting> settings) {
  if (name == "tqt") {
    auto config = ConfigFromSettings<GaussNewtonConfig>(name, GaussNewtonFields(), settings, {});
    if (!config) {
      return config.error();
    }
    return MakeGaussNewtonOrientation(*config);
  }
  if (name == "ckf" || name == "ckf-plain") {
    ComplementaryKalmanConfig defaults;
    defaults.use_disturbance = name == "ckf";
    return Make<ComplementaryKalman>(name, ComplementaryKalmanFields(), settings, defaults);
  }
  if (name == "bmf") {
    return MakeBoundedMotion("bmf", settings, BoundedMotionConfig());
  }
  if (name == "bmf-plain") {
    return MakeBoundedMotion("bmf-plain", settings, PlainBoundedMotionConfig());
  }
  return Error{ErrorCode::kInvalidArgument, "filter must be " + internal::ChoicesText(kNames) +
                                                ", is '" + std::string(name) + "'"};
}

}  // namespace limbcast::filters
