#pragma once

#include <Eigen/Geometry>
#include <cstddef>
#include <optional>
#include <span>
#include <string_view>

#include "common/body/segment.hpp"

namespace limbcast::body {

/// How the person stands while the offsets are taken. The segment axes of both poses are those of
/// the N-pose.
enum class ReferencePose {
  kNPose,  ///< upright, arms hanging, palms inwards: every segment is the identity
  kTPose,  ///< upright, arms straight out to the sides, palms down
};

/// "n_pose" | "t_pose".
[[nodiscard]] std::optional<ReferencePose> ParseReferencePose(std::string_view name);
[[nodiscard]] std::string_view ToString(ReferencePose pose);

/// Orientation of a segment in the pose of a body that faces +x.
[[nodiscard]] Eigen::Quaterniond ReferenceOrientation(ReferencePose pose, Segment segment);

/// The rotation about earth z by `heading_rad`: it turns a body that faces +x to that heading.
[[nodiscard]] Eigen::Quaterniond HeadingRotation(double heading_rad);

/// How one sensor sits on its segment, and how wrong its idea of heading is:
///
///   q_earth_segment = Rz(heading_correction) ⊗ q_earth_sensor ⊗ q_sensor_segment
///
/// The right factor is q_offset of Bachmann et al., Eq. (33); the left one is not in the paper,
/// whose sensors all share magnetic north. It is the identity until a heading is reset.
class SensorAlignment {
 public:
  SensorAlignment() = default;
  SensorAlignment(const Eigen::Quaterniond& q_sensor_segment, double heading_correction_rad);

  [[nodiscard]] Eigen::Quaterniond Apply(const Eigen::Quaterniond& q_earth_sensor) const {
    return q_heading_ * q_earth_sensor * q_sensor_segment_;
  }

  /// Sets the offset so that Apply(q_earth_sensor) is q_earth_segment: q_offset is the inverse of
  /// the sensor's orientation in the reference pose, Eq. (34), for a body that faces any way. The
  /// heading correction stays.
  ///
  /// A single pose cannot tell how a sensor is mounted about the vertical from what it thinks its
  /// heading is. The result is exact when the heading of the sensor (after correction) is that of
  /// the frame in which the segment is given. For a sensor without magnetometer it is right up to
  /// an unknown turn of the axes it moves about; that needs movement to find.
  void SetFromReferencePose(const Eigen::Quaterniond& q_earth_sensor,
                            const Eigen::Quaterniond& q_earth_segment);

  /// Turns what Apply gives by `by_rad` about earth z.
  void TurnHeading(double by_rad);

  [[nodiscard]] const Eigen::Quaterniond& q_sensor_segment() const { return q_sensor_segment_; }
  /// In (−π, π].
  [[nodiscard]] double heading_correction_rad() const { return heading_correction_rad_; }

 private:
  Eigen::Quaterniond q_sensor_segment_ = Eigen::Quaterniond::Identity();
  double heading_correction_rad_ = 0.0;
  Eigen::Quaterniond q_heading_ = Eigen::Quaterniond::Identity();  // of heading_correction_rad_
};

/// What a window of orientations says of a sensor that should have been still.
struct OrientationAverage {
  Eigen::Quaterniond mean = Eigen::Quaterniond::Identity();
  double spread_rad = 0.0;  ///< largest angle between the mean and one of them
  std::size_t count = 0;
};

/// The normalised sum of the quaternions with their signs made alike, Gramkow 2001, "On averaging
/// rotations", Eq. (14); it differs from the mean on SO(3) by the third order of the spread. No
/// sample: the identity, count 0.
[[nodiscard]] OrientationAverage Average(std::span<const Eigen::Quaterniond> orientations);

}  // namespace limbcast::body
