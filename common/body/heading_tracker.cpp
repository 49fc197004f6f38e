#include "common/body/heading_tracker.hpp"

#include <algorithm>
#include <cmath>

#include "common/math/angles.hpp"
#include "common/math/rotation.hpp"

namespace limbcast::body {
namespace {

constexpr double kMaxStep_s = 0.1;
/// Both legs turn by this (rms) in a walk of 0.5 m/s and more, and hardly in any stance.
constexpr double kWalkingRate_rad_s = 0.7;
constexpr double kActivityTime_s = 1.5;
/// A walk in a bend has this rate; turning on the spot is faster.
constexpr double kTurningRate_rad_s = 0.5;
/// What a heading may have drifted between two observations, 1σ: weighs the one against the other.
constexpr double kDrift_rad = 0.1;
/// Biases of gyroscopes that a filter leaves are below this; 0.2°/s.
constexpr double kMaxRate_rad_s = 0.0035;
/// Beyond this from upright a segment's heading is not the way it faces.
constexpr double kMinUpright = 0.3;  // cos 72°

/// The way across the left axis, about which trunk and legs bend: unlike the twist about the
/// vertical it does not change with bending. In (−π, π].
double Facing_rad(const Eigen::Quaterniond& q_earth_segment) {
  const Eigen::Vector3d left = q_earth_segment * Eigen::Vector3d::UnitY();
  return std::atan2(-left.x(), left.y());
}

math::AngleMean HeadingOfTrunk(const PerSegment<bool>& use,
                               const PerSegment<Eigen::Quaterniond>& q_earth_segment) {
  math::AngleMean heading;
  for (std::size_t i = 0; i < Index(Segment::kNeck); ++i) {  // the head looks where it likes
    if (use[i]) {
      heading.Add(Facing_rad(q_earth_segment[i]));
    }
  }
  return heading;
}

/// What a segment's facing is compared with: the thigh for a shank, else the trunk.
double ReferenceFacing_rad(Segment segment, double trunk_rad, const PerSegment<bool>& use,
                           const PerSegment<Eigen::Quaterniond>& q_earth_segment) {
  const bool shank = segment == Segment::kRightLowerLeg || segment == Segment::kLeftLowerLeg;
  const std::size_t thigh = shank ? Index(segment) - 1 : 0;
  return shank && use[thigh] ? Facing_rad(q_earth_segment[thigh]) : trunk_rad;
}

}  // namespace

void HeadingTracker::NoteActivity(double dt_s, const PerSegment<bool>& use,
                                  const PerSegment<Eigen::Quaterniond>& q_earth_segment) {
  const double share = std::min(1.0, dt_s / kActivityTime_s);
  bool right = false;
  bool left = false;
  for (std::size_t i = Index(Segment::kRightUpperLeg); i < kSegmentCount; ++i) {
    if (use[i] && last_use_[i] && dt_s > 0.0) {
      const double rate_rad_s = math::AngleBetween_rad(last_q_[i], q_earth_segment[i]) / dt_s;
      activity_rad2_s2_[i] += share * (rate_rad_s * rate_rad_s - activity_rad2_s2_[i]);
    }
    const bool moves = use[i] && activity_rad2_s2_[i] > kWalkingRate_rad_s * kWalkingRate_rad_s;
    (i < Index(Segment::kLeftUpperLeg) ? right : left) |= moves;
  }
  walking_ = right && left;
}

const PerSegment<double>& HeadingTracker::Update(
    double dt_s, const PerSegment<bool>& use,
    const PerSegment<Eigen::Quaterniond>& q_earth_segment) {
  turn_rad_.fill(0.0);
  const math::AngleMean trunk = HeadingOfTrunk(use, q_earth_segment);
  const bool trunk_known = trunk.length() > 0.0;
  const double trunk_heading_rad = trunk.Mean_rad();
  if (has_last_ && dt_s <= kMaxStep_s && trunk_known) {
    NoteActivity(dt_s, use, q_earth_segment);
    if (dt_s > 0.0) {
      const double rate_rad_s =
          math::WrappedAngle_rad(trunk_heading_rad - trunk_heading_rad_) / dt_s;
      trunk_rate_rad_s_ += std::min(1.0, dt_s / kActivityTime_s) * (rate_rad_s - trunk_rate_rad_s_);
    }
    const bool correct = walking_ && std::abs(trunk_rate_rad_s_) < kTurningRate_rad_s;
    for (std::size_t i = 0; correct && i < kSegmentCount; ++i) {
      const auto segment = static_cast<Segment>(i);
      if (IsArm(segment)) {
        continue;
      }
      const double upright =
          q_earth_segment[i].toRotationMatrix()(2, 2);  // cosine of its inclination
      if (!use[i] || upright < kMinUpright) {
        continue;
      }
      const double ahead_rad =
          ReferenceFacing_rad(segment, trunk_heading_rad, use, q_earth_segment);
      const double error_rad = math::WrappedAngle_rad(Facing_rad(q_earth_segment[i]) - ahead_rad);
      turn_rad_[i] = -error_rad * dt_s / config_.time_constant_s;
    }
  }
  for (std::size_t i = 0; i < kSegmentCount; ++i) {
    if (use[i] && observed_rad_[i] != 0.0) {
      const double part_rad = observed_rad_[i] * std::min(1.0, dt_s / config_.arm_time_constant_s);
      observed_rad_[i] -= part_rad;
      turn_rad_[i] -= part_rad;
    }
    if (!use[i] || !has_last_ || dt_s > kMaxStep_s) {
      turn_rad_[i] = 0.0;
      continue;
    }
    const double most_rad = config_.max_rate_rad_s * dt_s;
    turn_rad_[i] = std::clamp(turn_rad_[i], -most_rad, most_rad);
    // The integral beside the proportional part: what is left of a steady drift is nothing.
    rate_rad_s_[i] = std::clamp(rate_rad_s_[i] + turn_rad_[i] / config_.rate_time_s,
                                -kMaxRate_rad_s, kMaxRate_rad_s);
    turn_rad_[i] += rate_rad_s_[i] * dt_s;
  }
  has_last_ = trunk_known;
  trunk_heading_rad_ = trunk_heading_rad;
  last_q_ = q_earth_segment;
  last_use_ = use;
  return turn_rad_;
}

void HeadingTracker::Observe(Segment segment, double error_rad, double sigma_rad) {
  const double ratio = sigma_rad / kDrift_rad;
  observed_rad_[Index(segment)] = math::WrappedAngle_rad(error_rad) / (1.0 + ratio * ratio);
}

void HeadingTracker::Forget(Segment segment) { observed_rad_[Index(segment)] = 0.0; }

}  // namespace limbcast::body
