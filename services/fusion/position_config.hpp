#pragma once

#include <optional>
#include <vector>

#include "common/base/result.hpp"
#include "common/body/segment.hpp"
#include "common/config/config_file.hpp"
#include "common/filters/position/coil_inertial_config.hpp"
#include "common/filters/position/optical_inertial_config.hpp"

namespace limbcast::fusion {

/// Sensors that are tracked from a source of coils on the same body: table [fusion.coils].
struct CoilAidConfig {
  /// Key `source`: the segment whose sensor carries the coils, "" = none.
  std::optional<body::Segment> source;
  /// Key `sensors`: the segments that are tracked from it.
  std::vector<body::Segment> sensors = {body::Segment::kRightForeArm, body::Segment::kLeftForeArm,
                                        body::Segment::kRightLowerLeg,
                                        body::Segment::kLeftLowerLeg};
  /// Of a pulse's plateau. Range: [0.01, 20].
  double current_a = 1.5;
  /// Keys radius_m, turns, sigma_mag_nt, walk_background_nt_rts, relative_field_error.
  filters::CoilInertialConfig filter = DefaultFilter();

 private:
  [[nodiscard]] static filters::CoilInertialConfig DefaultFilter();
};

/// Sensors that carry a marker; the marker's number is the segment's: table [fusion.markers].
struct MarkerAidConfig {
  std::vector<body::Segment> segments;  ///< none: markers are not listened to
  /// Keys sigma_mm, lever_arm_m (three numbers; estimated from there on).
  filters::OpticalInertialConfig filter;
};

/// Which segments have a position beside their orientation.
struct PositionConfig {
  CoilAidConfig coils;
  MarkerAidConfig markers;
  /// Key fusion.position_lag_s: positions are published a second time as slot 2, smoothed by what
  /// came in so many seconds after them. 0 = not. Range: [0, 2].
  double lag_s = 0.0;
};

/// Reads [fusion.coils], [fusion.markers] and the lag; refusals are remembered in the section's
/// file.
[[nodiscard]] PositionConfig ReadPositionConfig(const config::Section& fusion);

[[nodiscard]] Status Validate(const PositionConfig& config);

}  // namespace limbcast::fusion
