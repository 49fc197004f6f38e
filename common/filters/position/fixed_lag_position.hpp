#pragma once

#include <cstddef>
#include <vector>

#include "common/filters/position/optical_outputs.hpp"

namespace limbcast::filters {

/// Fixed-lag output of the inertial + optical filter: for each new epoch the estimate of the newest
/// epoch that is at least `lag` old, corrected by all that was measured since (design/position.md
/// section 5). A filter restart begins a new window. Allocates at construction only.
/// Thread-compatible.
class FixedLagPosition {
 public:
  /// @param config  valid; lag_s and block_s are used.
  explicit FixedLagPosition(const OpticalInertialConfig& config);

  /// Takes a closed epoch.
  void Push(const OpticalEpoch& epoch);

  /// There is an epoch old enough.
  [[nodiscard]] bool has_estimate() const { return has_estimate_; }
  /// The lagged estimate. Its covariance is computed with every epoch inside gaps and with every
  /// eighth elsewhere, where it hardly changes; between, the last one is kept.
  [[nodiscard]] const PositionEstimate& estimate() const { return estimate_; }

 private:
  static constexpr int kCovarianceEvery = 8;

  LagWindow<optical::kStates, optical::kMoving, optical::kMarkerAxes, optical::kOutputs> window_;
  std::vector<PositionEstimate> forward_;  // ring beside the window's
  std::size_t newest_ = 0;
  Duration lag_;
  bool has_estimate_ = false;
  PositionEstimate estimate_;
  Eigen::Matrix3d last_cov_m2_ = Eigen::Matrix3d::Zero();
  int since_covariance_ = kCovarianceEvery;
};

}  // namespace limbcast::filters
