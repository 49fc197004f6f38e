#pragma once

#include <Eigen/Geometry>

#include "common/base/time.hpp"

namespace limbcast::posture {

/// Takes a segment from an old alignment to a new one without a jump: what turns the new
/// orientation into the old one fades out over a span. Thread-compatible; no allocation.
class AlignmentBlend {
 public:
  /// `q_old` and `q_new` are the segment under the old and new alignment at `at`.
  void Start(const Eigen::Quaterniond& q_old, const Eigen::Quaterniond& q_new, Time at,
             Duration span);

  /// What is to be shown at `at` instead of `q_new`: Exp(s·Log(q_old ⊗ q_new*)) ⊗ q_new, with s
  /// from 1 to 0 with no jump of the rate at either end, 1 − 3u² + 2u³.
  [[nodiscard]] Eigen::Quaterniond Apply(const Eigen::Quaterniond& q_new, Time at);

  [[nodiscard]] bool active() const { return active_; }
  void Stop() { active_ = false; }

 private:
  bool active_ = false;
  Eigen::Vector3d left_rad_ = Eigen::Vector3d::Zero();  // in the earth frame, at s = 1
  Time from_{};
  Duration span_{};
};

}  // namespace limbcast::posture
