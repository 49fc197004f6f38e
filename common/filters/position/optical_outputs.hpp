#pragma once

#include "common/filters/position/lag_window.hpp"
#include "common/filters/position/optical_inertial_filter.hpp"
#include "common/filters/position/position_estimate.hpp"

namespace limbcast::filters {

/// The outputs that smoothers correct, in this order: marker position, sensor position, velocity,
/// attitude, acceleration (3 each).
namespace optical {
inline constexpr int kOutMarker = 0;
inline constexpr int kOutP = 3;
inline constexpr int kOutV = 6;
inline constexpr int kOutTheta = 9;
inline constexpr int kOutAccel = 12;
inline constexpr int kOutputs = 15;
using OutputRows = Eigen::Matrix<double, kOutputs, kStates>;
using OutputVector = Eigen::Matrix<double, kOutputs, 1>;
}  // namespace optical

/// The forward estimate of an epoch. The marker's position is the one at the epoch's own time, and
/// at the time that the marker's stamps mean: p + R r + t_d (v + R (w × r)).
[[nodiscard]] PositionEstimate ForwardEstimate(const OpticalEpoch& epoch);

/// Covariance of the outputs with the error state, C P⁺: what a smoother keeps of an epoch.
[[nodiscard]] optical::OutputRows OutputRowsOf(const OpticalEpoch& epoch);

/// Adds a smoother's correction of the outputs.
void Correct(const optical::OutputVector& correction, PositionEstimate& estimate);

}  // namespace limbcast::filters
