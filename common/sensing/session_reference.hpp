#pragma once

#include <span>
#include <string>
#include <vector>

#include "common/base/result.hpp"
#include "common/sensing/marg_sample.hpp"
#include "common/sensing/rest_poses.hpp"

namespace limbcast::sensing {

/// How the local gravity and field are measured before a session, and what counts as disturbed.
struct SessionConfig {
  /// Only this much from the first sample on is looked at. Range: [0.5, 60].
  double window_s = 5.0;
  /// Magnetic north's bearing from true north, clockwise (east) positive. Range: [−π, π].
  double declination_rad = 0.0;
  /// What the field is expected to be; 0: the median of the sensors. Range: [0, 1e-4] tesla.
  double expected_field_tesla = 0.0;
  /// Disturbed above this difference in strength, as a fraction. Range: (0, 1].
  double max_field_error = 0.1;
  /// Disturbed above this difference in dip. Range: (0, 1.6].
  double max_dip_error_rad = 0.1;
  RestConfig rest = RestConfig();
};

/// Gravity and field as one sensor at rest saw them, after calibration. The length of gravity and
/// the dip are the same for all sensors of a session; what differs is disturbed.
struct SessionReference {
  double gravity_m_s2 = 0.0;
  double field_tesla = 0.0;  ///< 0: no magnetometer
  double dip_rad = 0.0;      ///< below the horizontal, downwards positive
  double declination_rad = 0.0;
  double rest_s = 0.0;  ///< how long the sensor lay still
};

/// From the longest rest in the first seconds. kInvalidArgument when the sensor never was still.
[[nodiscard]] Result<SessionReference> MeasureSessionReference(std::span<const MargSample> samples,
                                                               const SessionConfig& config);

/// What one sensor's field is against that of the session.
struct FieldVerdict {
  bool disturbed = false;
  std::string reason;  ///< "field 62.1 uT, expected 48.6 uT; dip …"; "" when it is not
};

/// The session's field: the expected one where given, else the medians over the sensors that have a
/// magnetometer. field_tesla is 0 when none has.
[[nodiscard]] SessionReference CommonReference(std::span<const SessionReference> sensors,
                                               const SessionConfig& config);

/// One verdict for each sensor, in their order: which limbs see a disturbed field. Sensors without
/// a magnetometer see none.
[[nodiscard]] std::vector<FieldVerdict> JudgeField(std::span<const SessionReference> sensors,
                                                   const SessionConfig& config);

}  // namespace limbcast::sensing
