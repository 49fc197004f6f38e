#pragma once

#include <Eigen/Geometry>

#include "common/base/ids.hpp"
#include "common/base/time.hpp"
#include "common/body/segment.hpp"

namespace limbcast::body {

/// Where a segment and its sensor really are, from a simulator or an optical system (topic
/// `truth`). For tests, demos and figures; no service computes with it.
struct SegmentTruth {
  BodyId body_id;
  Segment segment = Segment::kPelvis;
  SensorUid sensor_uid;
  Time measured_at{};
  bool sensor_valid = false;   ///< q_earth_sensor is known
  bool segment_valid = false;  ///< q_earth_segment and p_earth_segment_m are known
  Eigen::Quaterniond q_earth_sensor = Eigen::Quaterniond::Identity();
  Eigen::Quaterniond q_earth_segment = Eigen::Quaterniond::Identity();
  Eigen::Vector3d p_earth_segment_m = Eigen::Vector3d::Zero();  ///< inboard end of the segment
  /// Means something with segment_valid; zero: not known, as in recordings.
  Eigen::Vector3d p_earth_sensor_m = Eigen::Vector3d::Zero();
};

}  // namespace limbcast::body
