#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <vector>

#include "common/body/contact_points.hpp"
#include "common/body/forward_kinematics.hpp"
#include "common/math/rotation.hpp"
#include "common/simulation/person_motion.hpp"

namespace limbcast::test_support {

/// Judges the root of a person against the simulated truth: how far points that truly rest on the
/// ground slide, how deep they sink, and how far the person is said to have walked.
class WalkingSlip {
 public:
  explicit WalkingSlip(const body::BodyDefinition& body) : points_(body::MakeContactPoints(body)) {
    resting_.resize(points_.size());
  }

  /// A frame at 100 Hz: `truth` and where we say the segments are, at the same instant.
  void Add(const simulation::PersonPose& truth, const body::PerSegment<Eigen::Quaterniond>& q,
           const body::PerSegment<Eigen::Vector3d>& p_m) {
    for (std::size_t i = 0; i < points_.size(); ++i) {
      const body::ContactPoint& point = points_[i];
      const std::size_t segment = body::Index(point.segment);
      const bool foot = segment == body::Index(body::Segment::kRightFoot) ||
                        segment == body::Index(body::Segment::kLeftFoot);
      if (!foot) {
        continue;
      }
      const auto& rigid = truth.segments[segment];
      const Eigen::Vector3d arm_m = rigid.R_earth_local * point.p_segment_point_m;
      const Eigen::Vector3d true_m = rigid.p_earth_local_m + arm_m;
      const Eigen::Vector3d speed_m_s =
          rigid.v_earth_local_m_s + rigid.w_earth_local_rad_s.cross(arm_m);
      const Eigen::Vector3d said_m = p_m[segment] + q[segment] * point.p_segment_point_m;
      deepest_m_ = std::max(deepest_m_, point.radius_m - said_m.z());
      if (true_m.z() - point.radius_m < 1e-3 && speed_m_s.norm() < 0.02) {
        resting_[i].push_back(said_m.head<2>());
      } else {
        Close(i);
      }
    }
    const Eigen::Vector2d said_m = p_m[0].head<2>();
    const Eigen::Vector2d true_m = truth.segments[0].p_earth_local_m.head<2>();
    if (frames_ == 0) {
      offset_m_ = said_m - true_m;
      last_said_m_ = said_m;
      last_true_m_ = true_m;
    }
    // Ways are measured from second to second, as noise from frame to frame is no way walked.
    if (++frames_ % 100 == 0) {
      said_way_m_ += (said_m - last_said_m_).norm();
      true_way_m_ += (true_m - last_true_m_).norm();
      last_said_m_ = said_m;
      last_true_m_ = true_m;
    }
    farthest_off_m_ = std::max(farthest_off_m_, (said_m - true_m - offset_m_).norm());
  }

  void Finish() {
    for (std::size_t i = 0; i < points_.size(); ++i) {
      Close(i);
    }
    std::sort(slips_m_.begin(), slips_m_.end());
  }

  [[nodiscard]] std::size_t steps() const { return slips_m_.size(); }
  [[nodiscard]] double worst_slip_m() const { return slips_m_.empty() ? 0.0 : slips_m_.back(); }
  [[nodiscard]] double slip_m(double quantile) const {
    return slips_m_.empty() ? 0.0
                            : slips_m_[static_cast<std::size_t>(
                                  quantile * static_cast<double>(slips_m_.size() - 1))];
  }
  /// Of contacts longer than a step: standing and sitting.
  [[nodiscard]] double worst_standing_m() const { return worst_standing_m_; }
  [[nodiscard]] double deepest_m() const { return deepest_m_; }
  [[nodiscard]] double true_way_m() const { return true_way_m_; }
  [[nodiscard]] double said_way_m() const { return said_way_m_; }
  [[nodiscard]] double farthest_off_m() const { return farthest_off_m_; }

 private:
  // One contact of a point is over: its slip is the largest distance from where it began.
  void Close(std::size_t i) {
    double slip_m = 0.0;
    for (const Eigen::Vector2d& p_m : resting_[i]) {
      slip_m = std::max(slip_m, (p_m - resting_[i].front()).norm());
    }
    if (resting_[i].size() > kLongestStep_frames) {
      worst_standing_m_ = std::max(worst_standing_m_, slip_m);
    } else if (resting_[i].size() > 3) {
      slips_m_.push_back(slip_m);
    }
    resting_[i].clear();
  }

  static constexpr std::size_t kLongestStep_frames = 150;

  std::vector<body::ContactPoint> points_;
  std::vector<std::vector<Eigen::Vector2d>> resting_;
  std::vector<double> slips_m_;
  double worst_standing_m_ = 0.0;
  double deepest_m_ = 0.0;
  double said_way_m_ = 0.0;
  double true_way_m_ = 0.0;
  double farthest_off_m_ = 0.0;
  std::size_t frames_ = 0;
  Eigen::Vector2d last_said_m_ = Eigen::Vector2d::Zero();
  Eigen::Vector2d last_true_m_ = Eigen::Vector2d::Zero();
  Eigen::Vector2d offset_m_ = Eigen::Vector2d::Zero();
};

}  // namespace limbcast::test_support
