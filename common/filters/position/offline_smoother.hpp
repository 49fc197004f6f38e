#pragma once

#include <span>
#include <vector>

#include "common/filters/position/interval_smoother.hpp"

namespace limbcast::filters {

/// What smoothing a recording gave.
struct OfflineResult {
  std::vector<PositionEstimate> estimates;  ///< one for each epoch, in order; empty: never started
  OpticalInertialState start;  ///< smoothed state of the first epoch, with all sensor errors
  MarkerCounters markers;
  VerdictCounters inertial;
  bool began_at_rest = false;  ///< epochs reach back to the rest before the motion
};

/// Smooths a recording of one inertial unit and one marker: finds the attitude as the live filter
/// does, goes back to the rest before that when there was one, runs forward over everything, and
/// back. `passes` > 1 repeats this from the smoothed start, so that the linear model is that of a
/// calibrated sensor from the first sample on; the prior stays as wide as it was. On BROAD it gains
/// 0 to 2 %, so one pass is the default.
///
/// @param samples, markers  in the order of their times.
/// @param config            valid.
[[nodiscard]] OfflineResult SmoothOffline(const OpticalInertialConfig& config,
                                          std::span<const sensing::MargSample> samples,
                                          std::span<const sensing::MarkerPosition> markers,
                                          int passes = 1);

}  // namespace limbcast::filters
