#include "services/posture/posture_config.hpp"

#include <fmt/format.h>

#include "common/config/named_values.hpp"

namespace limbcast::posture {
namespace {

constexpr std::size_t kMaxPathLength = 4096;
constexpr double kFarthestPlace_m = 0.5;

Status InRange(const char* key, double value, double low, double high) {
  if (value >= low && value <= high) {
    return Ok();
  }
  return Error{ErrorCode::kInvalidArgument,
               fmt::format("posture.{} must be in [{}, {}], is {}", key, low, high, value)};
}

}  // namespace

Status Validate(const PostureConfig& config) {
  for (const Status& status : {InRange("workers", config.workers, 1, 64),
                               InRange("tick_deadline_s", config.tick_deadline_s, 0.0005, 1.0),
                               InRange("output_rate_hz", config.output_rate_hz, 0.0, 1000.0),
                               InRange("max_extrapolation_s", config.max_extrapolation_s, 0.0, 1.0),
                               InRange("missing_after_s", config.missing_after_s, 0.05, 600.0),
                               InRange("still_window_s", config.still_window_s, 0.05, 2.0),
                               InRange("still_limit_rad", config.still_limit_rad, 1e-6, 1.0),
                               InRange("body_height_m", config.body_height_m,
                                       body::kMinBodyHeight_m, body::kMaxBodyHeight_m),
                               InRange("joint_softness_rad", config.joint_softness_rad, 0.001, 1.0),
                               InRange("blend_s", config.blend_s, 0.0, 5.0)}) {
    if (!status) {
      return status;
    }
  }
  for (const auto& [segment, place_m] : config.sensor_places_m) {
    if (!(place_m.cwiseAbs().maxCoeff() <= kFarthestPlace_m)) {
      return Error{ErrorCode::kInvalidArgument,
                   fmt::format("posture.sensor_places.{} must be within {} m, is {} m away",
                               body::ToString(segment), kFarthestPlace_m, place_m.norm())};
    }
  }
  if (config.output_rate_hz != 0.0) {
    return InRange("output_rate_hz", config.output_rate_hz, 1.0, 1000.0);
  }
  return Ok();
}

PostureConfig ReadPostureConfig(const config::Section& section) {
  PostureConfig config;
  config.workers = section.Read("workers", config.workers, 1U, 64U);
  config.tick_deadline_s = section.Read("tick_deadline_s", config.tick_deadline_s, 0.0005, 1.0);
  config.output_rate_hz = section.Read("output_rate_hz", config.output_rate_hz, 0.0, 1000.0);
  if (config.output_rate_hz != 0.0 && config.output_rate_hz < 1.0) {
    section.Fail("output_rate_hz",
                 fmt::format("must be 0 or in [1, 1000], is {}", config.output_rate_hz));
    config.output_rate_hz = 0.0;
  }
  config.max_extrapolation_s =
      section.Read("max_extrapolation_s", config.max_extrapolation_s, 0.0, 1.0);
  config.missing_after_s = section.Read("missing_after_s", config.missing_after_s, 0.05, 600.0);
  config.still_window_s = section.Read("still_window_s", config.still_window_s, 0.05, 2.0);
  config.still_limit_rad = section.Read("still_limit_rad", config.still_limit_rad, 1e-6, 1.0);
  config.body_height_m = section.Read("body_height_m", config.body_height_m, body::kMinBodyHeight_m,
                                      body::kMaxBodyHeight_m);
  config.segments = config::ReadNamedList(section, "segments", config.segments, body::ParseSegment,
                                          "segments like left_upper_arm");
  config.joint_limits = section.Read("joint_limits", config.joint_limits);
  config.joint_softness_rad =
      section.Read("joint_softness_rad", config.joint_softness_rad, 0.001, 1.0);
  config.contacts = section.Read("contacts", config.contacts);
  config.joint_angles = section.Read("joint_angles", config.joint_angles);
  config.blend_s = section.Read("blend_s", config.blend_s, 0.0, 5.0);
  config.automatic_calibration =
      section.Read("automatic_calibration", config.automatic_calibration);
  config.heading_tracking = section.Read("heading_tracking", config.heading_tracking);
  config.positions = section.Read("positions", config.positions);
  const config::Section places = section.Get("sensor_places");
  for (const std::string& name : places.Keys()) {
    const auto place = places.ReadNumbers(name, {}, -kFarthestPlace_m, kFarthestPlace_m, 3);
    const auto segment = body::ParseSegment(name);
    if (!segment) {
      places.Fail(name, "is not a segment like pelvis or left_lower_leg");
    } else if (place.size() == 3) {
      config.sensor_places_m[*segment] = {place[0], place[1], place[2]};
    }
  }
  config.state_dir = section.Read("state_dir", config.state_dir, kMaxPathLength);
  return config;
}

}  // namespace limbcast::posture
