#include "services/fusion/position_config.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <string>

#include "common/config/named_values.hpp"

namespace limbcast::fusion {
namespace {

constexpr double kTeslaPerNanotesla = 1e-9;
constexpr double kMetresPerMillimetre = 1e-3;
constexpr double kMostLag_s = 2.0;

double ReadNanotesla(const config::Section& section, std::string_view key, double tesla, double min,
                     double max) {
  return kTeslaPerNanotesla * section.Read(key, tesla / kTeslaPerNanotesla, min, max);
}

Status CheckOnce(const char* key, const std::vector<body::Segment>& segments) {
  for (std::size_t i = 0; i < segments.size(); ++i) {
    if (std::find(segments.begin(), segments.begin() + static_cast<std::ptrdiff_t>(i),
                  segments[i]) != segments.begin() + static_cast<std::ptrdiff_t>(i)) {
      return Error{ErrorCode::kInvalidArgument,
                   fmt::format("{} names {} twice", key, body::ToString(segments[i]))};
    }
  }
  return Ok();
}

}  // namespace

// A body-worn unit of today at 15 nT beside iron furniture; design/position.md section 3 has the
// wider defaults of the library.
filters::CoilInertialConfig CoilAidConfig::DefaultFilter() {
  filters::CoilInertialConfig filter;
  filter.sigma_mag_tesla = 15e-9;
  filter.relative_field_error = 3e-3;
  filter.walk_background_tesla_rts = 0.2e-6;
  filter.rest_patience_s = 1e6;  // a wrong track is worse than none: wait until somebody stands
  filter.inertial.sigma_accel_m_s2_rthz = 3e-3;
  filter.inertial.k_accel = 5e-3;
  return filter;
}

PositionConfig ReadPositionConfig(const config::Section& fusion) {
  PositionConfig config;
  config.lag_s = fusion.Read("position_lag_s", config.lag_s, 0.0, kMostLag_s);
  const config::Section coils = fusion.Get("coils");
  config.coils.source = config::ReadNamedIfAny(coils, "source", config.coils.source,
                                               body::ParseSegment, "a segment like pelvis");
  config.coils.sensors = config::ReadNamedList(coils, "sensors", config.coils.sensors,
                                               body::ParseSegment, "segments like right_fore_arm");
  config.coils.current_a = coils.Read("current_a", config.coils.current_a, 0.01, 20.0);
  filters::CoilInertialConfig& filter = config.coils.filter;
  filter.source.radius_m = coils.Read("radius_m", filter.source.radius_m, 0.005, 1.0);
  filter.source.turns = coils.Read("turns", filter.source.turns, 1.0, 1e4);
  filter.sigma_mag_tesla =
      ReadNanotesla(coils, "sigma_mag_nt", filter.sigma_mag_tesla, 0.1, 10'000.0);
  filter.walk_background_tesla_rts = ReadNanotesla(
      coils, "walk_background_nt_rts", filter.walk_background_tesla_rts, 0.0, 100'000.0);
  filter.relative_field_error =
      coils.Read("relative_field_error", filter.relative_field_error, 0.0, 0.2);

  const config::Section markers = fusion.Get("markers");
  config.markers.segments =
      config::ReadNamedList(markers, "segments", config.markers.segments, body::ParseSegment,
                            "segments like right_fore_arm");
  filters::OpticalInertialConfig& optical = config.markers.filter;
  optical.sigma_marker_m =
      kMetresPerMillimetre *
      markers.Read("sigma_mm", optical.sigma_marker_m / kMetresPerMillimetre, 1e-3, 100.0);
  const auto lever = markers.ReadNumbers(
      "lever_arm_m", {optical.lever_arm_x_m, optical.lever_arm_y_m, optical.lever_arm_z_m}, -1.0,
      1.0, 3);
  if (lever.size() == 3) {
    optical.lever_arm_x_m = lever[0];
    optical.lever_arm_y_m = lever[1];
    optical.lever_arm_z_m = lever[2];
  }
  return config;
}

Status Validate(const PositionConfig& config) {
  const auto wrap = [](const char* table, const Status& status) {
    return status ? Ok()
                  : Status(Error{status.error().code,
                                 fmt::format("{}: {}", table, status.error().message)});
  };
  Status valid = CheckOnce("fusion.coils.sensors", config.coils.sensors);
  valid = valid ? CheckOnce("fusion.markers.segments", config.markers.segments) : valid;
  valid = valid ? wrap("fusion.coils", filters::Validate(config.coils.filter)) : valid;
  valid = valid ? wrap("fusion.markers", filters::Validate(config.markers.filter)) : valid;
  if (!valid) {
    return valid;
  }
  if (!(config.lag_s >= 0.0 && config.lag_s <= kMostLag_s)) {
    return Error{ErrorCode::kInvalidArgument,
                 fmt::format("fusion.position_lag_s must be in [0, 2], is {}", config.lag_s)};
  }
  if (!(config.coils.current_a >= 0.01 && config.coils.current_a <= 20.0)) {
    return Error{
        ErrorCode::kInvalidArgument,
        fmt::format("fusion.coils.current_a must be in [0.01, 20], is {}", config.coils.current_a)};
  }
  const auto& sensors = config.coils.sensors;
  if (config.coils.source &&
      std::find(sensors.begin(), sensors.end(), *config.coils.source) != sensors.end()) {
    return Error{ErrorCode::kInvalidArgument,
                 fmt::format("fusion.coils.sensors has {}, which carries the source",
                             body::ToString(*config.coils.source))};
  }
  return Ok();
}

}  // namespace limbcast::fusion
