#pragma once

#include <Eigen/Geometry>
#include <cstdint>
#include <string>

#include "common/base/ids.hpp"
#include "common/base/position_kind.hpp"
#include "common/base/time.hpp"
#include "common/base/tracking.hpp"
#include "common/base/verdict.hpp"
#include "common/body/segment.hpp"
#include "common/body/stage_times.hpp"

namespace limbcast::body {

/// The slot of positions that were smoothed by what came after them. Such a state is published
/// beside that of a later sample.
inline constexpr std::uint8_t kLaggedSlot = 2;

/// What one filter says of one segment's sensor after one sample. The fusion service publishes
/// exactly one for each sample it receives of an assigned sensor, used or refused ("one in, one
/// out"), so a gap here is a loss, and `sequence` acknowledges the sample.
struct SegmentState {
  BodyId body_id;
  Segment segment = Segment::kPelvis;
  std::uint8_t slot = 0;  ///< 0 = the filter in use, 1 = the one run beside it, 2 = kLaggedSlot
  SensorUid sensor_uid;
  std::uint32_t sequence = 0;                      ///< of the sample that this state answers
  SampleVerdict verdict = SampleVerdict::kNoData;  ///< of that sample
  bool started = false;   ///< false: no orientation yet, q_earth_sensor means nothing
  bool degraded = false;  ///< bridging a gap or running on part of the channels
  bool at_rest = false;
  MagneticState magnetic_state = MagneticState::kUnused;
  HeadingReference heading = HeadingReference::kArbitrary;
  Time measured_at{};
  StageTimes stages;
  Eigen::Quaterniond q_earth_sensor = Eigen::Quaterniond::Identity();
  Eigen::Vector3f w_earth_sensor_in_sensor_rad_s = Eigen::Vector3f::Zero();  ///< bias removed
  Eigen::Vector3f free_accel_in_earth_m_s2 = Eigen::Vector3f::Zero();        ///< gravity removed
  Eigen::Matrix3f cov_orientation_rad2 = Eigen::Matrix3f::Zero();  ///< earth-frame rotation error
  bool has_position = false;  ///< false: nothing that is said of a position means anything
  Eigen::Vector3f p_earth_sensor_m = Eigen::Vector3f::Zero();
  Eigen::Vector3f v_earth_sensor_m_s = Eigen::Vector3f::Zero();
  Eigen::Matrix3f cov_position_m2 = Eigen::Matrix3f::Zero();
  std::string filter;  ///< name of the filter, at most 16 characters
  std::uint64_t lost_count =
      0;                     ///< samples of this sensor that never arrived, by its sequence numbers
  VerdictCounters verdicts;  ///< of this sensor since the service started
  /// p_earth_sensor_m and v_earth_sensor_m_s count from there, always in earth axes. Sensor: that
  /// of the segment `position_from`, with the axes that its own orientation says.
  PositionReference position_reference = PositionReference::kEarth;
  Segment position_from = Segment::kPelvis;
  FillKind position_fill = FillKind::kNone;
};

}  // namespace limbcast::body
