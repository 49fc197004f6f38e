#include "common/body/root_tracker.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "common/math/rotation.hpp"

// Notation: E earth, R axes of the earth with their origin at the root.

namespace limbcast::body {
namespace {

constexpr Duration kLongestGap = std::chrono::milliseconds(250);  // longer: nothing is known of it
constexpr Duration kOldestFix = std::chrono::seconds(1);
constexpr double kShortestStep_s = 1e-4;
constexpr double kTrusted = 1e-3;  // sum of trusts below which nobody stands
constexpr double kSpeedSmoothing_s = 0.02;
// Another point is stood on when the last one's unrest is more than this above its own.
constexpr double kQuieterBy = 0.5;
constexpr double kQuieterTimes = 1.5;
constexpr double kSigmaAtRest_m = 0.01;  // sway and orientation errors move the root by this
constexpr double kToeTurn_s = 0.1;       // toes lie down and come up within this
constexpr double kToesBend_rad = 1.22;   // 70°, as far as toes bend up
constexpr std::array<std::pair<Segment, Segment>, 2> kFeet = {
    {{Segment::kRightFoot, Segment::kRightToe}, {Segment::kLeftFoot, Segment::kLeftToe}}};

/// Height of the root over the lowest point in the reference pose.
double StandingRoot_m(const BodyDefinition& body) {
  const ForwardKinematics kinematics(body);
  BodyPose pose;
  kinematics.Place(Eigen::Vector3d::Zero(), pose);
  double low_m = 0.0;
  for (const Segment segment : kinematics.segments()) {
    low_m = std::min(low_m, kinematics.End_m(segment, pose).z());
  }
  return -low_m;
}

/// Weight of a fix against what we know: σ²/(σ² + σ_fix²); 1 for an exact one.
double Gain(double sigma_m, double var_fix_m2) {
  const double var_m2 = sigma_m * sigma_m;
  return var_fix_m2 > 0.0 ? var_m2 / (var_m2 + var_fix_m2) : 1.0;
}

}  // namespace

RootTracker::RootTracker(const BodyDefinition& body, const RootTrackerConfig& config)
    : config_(config) {
  SetBody(body);
  p_earth_root_m_.z() = standing_root_m_;
}

void RootTracker::SetBody(const BodyDefinition& body) {
  points_.clear();
  for (ContactPoint& point : MakeContactPoints(body)) {
    Point& added = points_.emplace_back();
    added.point = std::move(point);
    added.contact = GroundContact(config_.contact);
  }
  const double standing_m = StandingRoot_m(body);
  p_earth_root_m_.z() += standing_m - standing_root_m_;
  standing_root_m_ = standing_m;
  has_toe_.fill(false);
  for (const SegmentDefinition& definition : body.segments) {
    has_toe_[0] = has_toe_[0] || definition.segment == kFeet[0].second;
    has_toe_[1] = has_toe_[1] || definition.segment == kFeet[1].second;
  }
  support_ = 0;
  Restart();
}

void RootTracker::OnPositionFix(const Eigen::Vector3d& p_earth_root_m,
                                const Eigen::Matrix3d& cov_m2, Time measured_at) {
  fix_ = Fix{.p_earth_root_m = p_earth_root_m,
             .var_along_m2 = std::max(0.0, 0.5 * (cov_m2(0, 0) + cov_m2(1, 1))),
             .var_up_m2 = std::max(0.0, cov_m2(2, 2)),
             .measured_at = measured_at};
}

void RootTracker::Update(Time at, const PerSegment<SegmentMotion>& motion, BodyPose& pose) {
  if (at < last_at_ || at - last_at_ > kLongestGap) {
    Restart();
  }
  const double dt_s = started_ ? std::max(kShortestStep_s, ToSeconds(at - last_at_)) : 0.01;
  stands_ = LocatePoints(motion, pose);
  Eigen::Vector3d step_m = Eigen::Vector3d::Zero();
  contacts_ = 0;
  if (stands_) {
    Observe(dt_s, motion);
    ChooseSupport();
    step_m.head<2>() = Step();
    step_m.z() = ground_m_ - lowest_m_ - p_earth_root_m_.z();
    p_earth_root_m_ += step_m;
  }
  if (started_) {
    v_earth_root_m_s_ = step_m / dt_s;
  }
  const double way_m = step_m.head<2>().norm();
  sigma_along_m_ += config_.drift_of_way * way_m;
  sigma_up_m_ += config_.drift_of_way * way_m;
  TakeFix(at);
  Correct(dt_s);
  started_ = true;
  last_at_ = at;

  for (Eigen::Vector3d& p_m : pose.p_earth_segment_m) {
    p_m += p_earth_root_m_;
  }
  LayToes(dt_s, pose);
}

bool RootTracker::LocatePoints(const PerSegment<SegmentMotion>& motion, const BodyPose& pose) {
  bool any = false;
  lowest_m_ = std::numeric_limits<double>::max();
  for (Point& point : points_) {
    const bool was_known = point.known && started_;
    const std::size_t i = Index(point.point.segment);
    const Eigen::Vector3d p_R =
        pose.p_earth_segment_m[i] + pose.q_earth_segment[i] * point.point.p_segment_point_m;
    // What is not a number must not become part of a sum that never ends.
    point.known = p_R.allFinite() &&
                  std::all_of(point.point.measured.begin(), point.point.measured.end(),
                              [&](Segment segment) { return motion[Index(segment)].usable; });
    if (!point.known) {
      point.contact.Reset();
      continue;
    }
    if (!was_known) {
      point.moved_m.setZero();
      point.v_root_point_m_s.setZero();
    } else {
      point.moved_m = (p_R - point.p_root_point_m).head<2>();
    }
    point.p_root_point_m = p_R;
    lowest_m_ = std::min(lowest_m_, p_R.z() - point.point.radius_m);
    any = any || point.point.segment != Segment::kPelvis;
  }
  return any;
}

void RootTracker::Observe(double dt_s, const PerSegment<SegmentMotion>& motion) {
  const double gain = -std::expm1(-dt_s / kSpeedSmoothing_s);
  for (Point& point : points_) {
    if (!point.known) {
      continue;
    }
    const SegmentMotion& sensor = motion[Index(point.point.segment)];
    point.contact.Observe({.height_m = point.p_root_point_m.z() - point.point.radius_m - lowest_m_,
                           .rate_rad_s = static_cast<double>(sensor.rate_rad_s),
                           .accel_m_s2 = static_cast<double>(sensor.accel_m_s2),
                           .dt_s = dt_s});
    point.v_root_point_m_s += gain * (point.moved_m / dt_s - point.v_root_point_m_s);
  }
}

void RootTracker::ChooseSupport() {
  std::size_t quietest = support_;
  for (std::size_t i = 0; i < points_.size(); ++i) {
    if (points_[i].known && (!points_[quietest].known ||
                             points_[i].contact.unrest() < points_[quietest].contact.unrest())) {
      quietest = i;
    }
  }
  const double unrest = points_[support_].contact.unrest();
  if (!points_[support_].known ||
      unrest > kQuieterBy + kQuieterTimes * points_[quietest].contact.unrest()) {
    support_ = quietest;
  }
}

Eigen::Vector2d RootTracker::Step() {
  const Point& support = points_[support_];
  double trust = 0.0;
  Eigen::Vector2d moved_m = Eigen::Vector2d::Zero();
  for (Point& point : points_) {
    if (!point.known) {
      continue;
    }
    point.contact.Decide((point.v_root_point_m_s - support.v_root_point_m_s).norm());
    contacts_ |= point.contact.touches() ? point.point.contacts : 0U;
    trust += point.contact.trust();
    moved_m += point.contact.trust() * point.moved_m;
  }
  return trust > kTrusted ? Eigen::Vector2d(-moved_m / trust) : Eigen::Vector2d(-support.moved_m);
}

void RootTracker::TakeFix(Time at) {
  if (!fix_) {
    return;
  }
  const Duration age = at - fix_->measured_at;
  const bool usable = age >= Duration::zero() && age <= kOldestFix;
  const double age_s = usable ? ToSeconds(age) : 0.0;
  Eigen::Vector3d off_m = fix_->p_earth_root_m + age_s * v_earth_root_m_s_ - p_earth_root_m_;
  const bool relocate = !fixed_ || off_m.head<2>().norm() > config_.relocate_beyond_m;
  const double along = relocate ? 1.0 : Gain(sigma_along_m_, fix_->var_along_m2);
  const double up = Gain(sigma_up_m_, fix_->var_up_m2);
  off_m.head<2>() *= along;
  off_m.z() *= up;
  sigma_along_m_ = relocate ? std::sqrt(fix_->var_along_m2) : sigma_along_m_ * std::sqrt(1 - along);
  sigma_along_m_ = std::max(sigma_along_m_, kSigmaAtRest_m);
  sigma_up_m_ = std::max(sigma_up_m_ * std::sqrt(1.0 - up), kSigmaAtRest_m);
  to_correct_m_ = off_m;
  if (relocate) {
    p_earth_root_m_ += off_m;
    ground_m_ += off_m.z();
    to_correct_m_.setZero();
  }
  fixed_ = true;
  fix_.reset();
}

void RootTracker::Correct(double dt_s) {
  const double left_m = to_correct_m_.norm();
  if (left_m == 0.0) {
    return;
  }
  // Whose own steps are not seen is moved by the fixes alone, and must not lag behind them.
  const double part = stands_ ? std::min(1.0, config_.correction_m_s * dt_s / left_m) : 1.0;
  const Eigen::Vector3d now_m = part * to_correct_m_;
  p_earth_root_m_ += now_m;
  ground_m_ += now_m.z();
  to_correct_m_ -= now_m;
}

void RootTracker::LayToes(double dt_s, BodyPose& pose) {
  for (std::size_t side = 0; side < kFeet.size(); ++side) {
    const std::size_t foot = Index(kFeet[side].first);
    const std::size_t toe = Index(kFeet[side].second);
    if (!has_toe_[side] || pose.known[toe]) {
      continue;
    }
    const bool on_ground = (contacts_ & (1U << toe)) != 0;
    toe_flat_[side] =
        std::clamp(toe_flat_[side] + (on_ground ? 1.0 : -1.0) * dt_s / kToeTurn_s, 0.0, 1.0);
    // How far the foot points down: the z of its x axis in E.
    const double down =
        -(pose.q_earth_segment[foot] * Eigen::Vector3d(Eigen::Vector3d::UnitX())).z();
    const double pitch_rad = std::min(kToesBend_rad, std::asin(std::clamp(down, 0.0, 1.0)));
    pose.q_earth_segment[toe] =
        pose.q_earth_segment[foot] * math::ExpSO3({0.0, -toe_flat_[side] * pitch_rad, 0.0});
  }
}

}  // namespace limbcast::body
