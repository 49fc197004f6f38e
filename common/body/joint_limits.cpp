#include "common/body/joint_limits.hpp"

#include <cmath>
#include <numbers>

namespace limbcast::body {
namespace {

constexpr double kDeg = std::numbers::pi / 180.0;
constexpr double kBeyondTheMean_deg = 20.0;

struct Row {
  double min_deg[3];
  double max_deg[3];
};
// In the order of AngleNames: extension … flexion, abduction … adduction, external … internal
// rotation; plantar … dorsiflexion, eversion … inversion (rotation of the foot: ours); extension …
// flexion, radial … ulnar deviation, pronation (ours: what a sensor at the middle of the fore arm
// does not see of the fore arm's).
constexpr Row kHip = {{-30.0, -45.0, -45.0}, {120.0, 30.0, 45.0}};
constexpr Row kAnkle = {{-50.0, -15.0, -20.0}, {20.0, 35.0, 20.0}};
constexpr Row kWrist = {{-70.0, -20.0, -40.0}, {80.0, 30.0, 40.0}};

AngleLimits Widened(const Row& row) {
  AngleLimits limits;
  for (Eigen::Index i = 0; i < 3; ++i) {
    limits.min_rad[i] = kDeg * (row.min_deg[i] - kBeyondTheMean_deg);
    limits.max_rad[i] = kDeg * (row.max_deg[i] + kBeyondTheMean_deg);
  }
  return limits;
}

}  // namespace

double SoftClamp(double value, double low, double high, double softness) {
  if (low > high) {
    return value;
  }
  if (value > high) {
    return high + softness * -std::expm1(-(value - high) / softness);
  }
  if (value < low) {
    return low - softness * -std::expm1(-(low - value) / softness);
  }
  return value;
}

std::optional<AngleLimits> LimitsOf(Joint joint) {
  switch (joint) {
    case Joint::kRightHip:
    case Joint::kLeftHip:
      return Widened(kHip);
    case Joint::kRightAnkle:
    case Joint::kLeftAnkle:
      return Widened(kAnkle);
    case Joint::kRightWrist:
    case Joint::kLeftWrist:
      return Widened(kWrist);
    default:
      return std::nullopt;
  }
}

Eigen::Quaterniond SoftLimited(Joint joint, const Eigen::Quaterniond& q_parent_child,
                               double softness_rad) {
  const auto limits = LimitsOf(joint);
  if (!limits) {
    return q_parent_child;
  }
  const JointAngles angles = AnglesOf(joint, Eigen::Quaterniond::Identity(), q_parent_child);
  if (angles.near_singular) {
    return q_parent_child;
  }
  Eigen::Vector3d limited_rad;
  for (Eigen::Index i = 0; i < 3; ++i) {
    limited_rad[i] =
        SoftClamp(angles.angle_rad[i], limits->min_rad[i], limits->max_rad[i], softness_rad);
  }
  return limited_rad == angles.angle_rad ? q_parent_child : RotationOf(joint, limited_rad);
}

}  // namespace limbcast::body
