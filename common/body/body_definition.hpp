#pragma once

#include <Eigen/Geometry>
#include <cstdint>
#include <string>
#include <vector>

#include "common/base/ids.hpp"
#include "common/base/time.hpp"
#include "common/base/tracking.hpp"
#include "common/body/segment.hpp"

namespace limbcast::body {

/// One segment of one person. Segment axes: x forward, y left, z up in the reference pose, so that
/// the reference pose of a body facing +x is the identity.
struct SegmentDefinition {
  Segment segment = Segment::kPelvis;
  bool tracked = false;  ///< a sensor is expected on it
  SensorUid sensor_uid;  ///< that sensor; 0 = none
  /// Where this segment's inboard end sits in its parent's axes (in the earth frame: zero for the
  /// root).
  Eigen::Vector3d p_parent_segment_m = Eigen::Vector3d::Zero();
  /// From the inboard to the outboard end, in the segment's own axes.
  Eigen::Vector3d p_segment_end_m = Eigen::Vector3d::Zero();
  /// Somebody measured its length: another body height does not change it. Does not travel.
  bool length_measured = false;
  /// Alignment in force: q_earth_segment = Rz(heading_correction_rad) * q_earth_sensor *
  /// q_sensor_segment (Bachmann Eq. 33–34, q_offset, after the sensor's heading was corrected).
  Eigen::Quaterniond q_sensor_segment = Eigen::Quaterniond::Identity();
  double heading_correction_rad = 0.0;  ///< about earth z; from heading resets
  bool aligned = false;  ///< q_sensor_segment comes from a calibration, not from the default
  /// How good that calibration was, 0 (no better than none) to 1. Does not travel.
  float alignment_quality = 1.0F;
  /// Joint limits about the segment's parent, x y z of the rotation vector [rad]; min > max means
  /// none.
  Eigen::Vector3d joint_min_rad = Eigen::Vector3d::Constant(1.0);
  Eigen::Vector3d joint_max_rad = Eigen::Vector3d::Constant(-1.0);
};

/// The person as the posture service computes with it (state topic: late joiners get the last one).
struct BodyDefinition {
  BodyId body_id;
  std::uint32_t revision = 0;  ///< grows with every change
  Time changed_at{};
  std::string name;  ///< at most 64 characters
  std::string reference_pose =
      "n_pose";  ///< the pose in which every segment is the identity; at most 16 characters
  HeadingReference heading = HeadingReference::kArbitrary;
  std::vector<SegmentDefinition> segments;  ///< every parent before its children; at most 32
};

/// The row of a segment; null when the body does not have it.
[[nodiscard]] const SegmentDefinition* Find(const BodyDefinition& body, Segment segment);
[[nodiscard]] SegmentDefinition* Find(BodyDefinition& body, Segment segment);

/// Takes over where the joints of a segment are, and whether somebody measured that.
void TakeDimensions(const SegmentDefinition& from, SegmentDefinition& into);

/// Takes over how the sensor sits on a segment, with its heading and quality; the sensor itself
/// stays. From SegmentDefinition(): forgets it.
void TakeAlignment(const SegmentDefinition& from, SegmentDefinition& into);

}  // namespace limbcast::body
