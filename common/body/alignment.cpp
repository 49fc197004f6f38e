#include "common/body/alignment.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "common/math/angles.hpp"
#include "common/math/rotation.hpp"

// Notation: E earth, S sensor, B segment.

namespace limbcast::body {

std::optional<ReferencePose> ParseReferencePose(std::string_view name) {
  for (const ReferencePose pose : {ReferencePose::kNPose, ReferencePose::kTPose}) {
    if (ToString(pose) == name) {
      return pose;
    }
  }
  return std::nullopt;
}

std::string_view ToString(ReferencePose pose) {
  return pose == ReferencePose::kNPose ? "n_pose" : "t_pose";
}

Eigen::Quaterniond ReferenceOrientation(ReferencePose pose, Segment segment) {
  constexpr double kQuarterTurn_rad = std::numbers::pi / 2.0;
  if (pose == ReferencePose::kTPose) {
    if (segment >= Segment::kRightUpperArm && segment <= Segment::kRightHand) {
      return math::ExpSO3({-kQuarterTurn_rad, 0.0, 0.0});  // −z, where the arm hangs, to −y
    }
    if (segment >= Segment::kLeftUpperArm && segment <= Segment::kLeftHand) {
      return math::ExpSO3({kQuarterTurn_rad, 0.0, 0.0});
    }
  }
  return Eigen::Quaterniond::Identity();
}

Eigen::Quaterniond HeadingRotation(double heading_rad) {
  return math::ExpSO3({0.0, 0.0, heading_rad});
}

SensorAlignment::SensorAlignment(const Eigen::Quaterniond& q_sensor_segment,
                                 double heading_correction_rad)
    : q_sensor_segment_(q_sensor_segment.normalized()) {
  TurnHeading(heading_correction_rad);
}

void SensorAlignment::SetFromReferencePose(const Eigen::Quaterniond& q_ES,
                                           const Eigen::Quaterniond& q_EB) {
  q_sensor_segment_ = math::Canonical(((q_heading_ * q_ES).conjugate() * q_EB).normalized());
}

void SensorAlignment::TurnHeading(double by_rad) {
  heading_correction_rad_ = math::WrappedAngle_rad(heading_correction_rad_ + by_rad);
  q_heading_ = HeadingRotation(heading_correction_rad_);
}

OrientationAverage Average(std::span<const Eigen::Quaterniond> orientations) {
  OrientationAverage average;
  average.count = orientations.size();
  if (orientations.empty()) {
    return average;
  }
  Eigen::Vector4d sum = Eigen::Vector4d::Zero();
  for (const Eigen::Quaterniond& q : orientations) {
    const Eigen::Quaterniond near = math::NearestSign(q, orientations.front());
    sum += Eigen::Vector4d(near.w(), near.x(), near.y(), near.z());
  }
  if (sum.norm() > 0.0) {
    average.mean = Eigen::Quaterniond(sum[0], sum[1], sum[2], sum[3]).normalized();
  }
  for (const Eigen::Quaterniond& q : orientations) {
    average.spread_rad = std::max(average.spread_rad, math::AngleBetween_rad(average.mean, q));
  }
  return average;
}

}  // namespace limbcast::body
