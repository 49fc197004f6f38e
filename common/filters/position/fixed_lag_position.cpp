#include "common/filters/position/fixed_lag_position.hpp"

#include <cmath>

namespace limbcast::filters {
namespace {

std::size_t EpochsFor(const OpticalInertialConfig& config) {
  // Blocks are at least half of block_s long (a block ends at the nearest sample).
  return static_cast<std::size_t>(std::ceil(2.0 * config.lag_s / config.block_s)) + 4;
}

}  // namespace

FixedLagPosition::FixedLagPosition(const OpticalInertialConfig& config)
    : window_(EpochsFor(config)),
      forward_(window_.capacity()),
      lag_(DurationFromSeconds(config.lag_s)) {}

void FixedLagPosition::Push(const OpticalEpoch& epoch) {
  if (epoch.record.chain_begins) {
    window_.Clear();
    since_covariance_ = kCovarianceEvery;
  }
  window_.Push(epoch.record, OutputRowsOf(epoch));
  newest_ = (newest_ + 1) % forward_.size();
  forward_[newest_] = ForwardEstimate(epoch);

  // The newest epoch that is old enough.
  const auto forward_at = [this](std::size_t back) -> const PositionEstimate& {
    return forward_[(newest_ + forward_.size() - back) % forward_.size()];
  };
  std::size_t back = 0;
  bool later_marker = false;
  while (back < window_.size() && epoch.at - forward_at(back).at < lag_) {
    later_marker = later_marker || forward_at(back).fill == FillKind::kMeasured;
    ++back;
  }
  has_estimate_ = back < window_.size();
  if (!has_estimate_) {
    return;
  }
  estimate_ = forward_at(back);
  Correct(window_.Correction(back), estimate_);
  const bool measured = estimate_.fill == FillKind::kMeasured;
  if (!measured && later_marker) {
    estimate_.fill = FillKind::kInertialSmoothed;
  }
  if (!measured || ++since_covariance_ >= kCovarianceEvery) {
    last_cov_m2_ = window_.Covariance<3>(back, estimate_.cov_position_m2);
    since_covariance_ = 0;
  }
  estimate_.cov_position_m2 = last_cov_m2_;
}

}  // namespace limbcast::filters
