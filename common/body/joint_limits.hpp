#pragma once

#include <Eigen/Core>
#include <optional>

#include "common/body/joint_angles.hpp"

namespace limbcast::body {

/// A value inside [low, high] stays; beyond by x it comes to lie beyond by s·(1 − e^(−x/s)).
/// low > high: no limit. @param softness  s, > 0.
[[nodiscard]] double SoftClamp(double value, double low, double high, double softness);

/// How far a joint turns, in the angles of AnglesOf.
struct AngleLimits {
  Eigen::Vector3d min_rad = Eigen::Vector3d::Zero();
  Eigen::Vector3d max_rad = Eigen::Vector3d::Zero();
};

/// Limits of hips, ankles and wrists; nothing for the others: knees and elbows are limited as
/// hinges (SegmentDefinition), shoulders pass through their singularity, and the spine is several
/// joints.
///
/// Means of healthy adults of the American Academy of Orthopaedic Surgeons, "Joint Motion: Method
/// of Measuring and Recording", 1965, and 20° more, as half of all people turn farther than the
/// mean and sensors are some degrees wrong.
[[nodiscard]] std::optional<AngleLimits> LimitsOf(Joint joint);

/// The orientation of the child in its parent with its angles softly limited; as it is when nothing
/// is beyond a limit, when the joint has none, or near the joint's singularity.
[[nodiscard]] Eigen::Quaterniond SoftLimited(Joint joint, const Eigen::Quaterniond& q_parent_child,
                                             double softness_rad);

}  // namespace limbcast::body
