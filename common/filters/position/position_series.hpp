#pragma once

#include <span>
#include <vector>

#include "common/filters/position/polynomial_fill.hpp"
#include "common/filters/position/position_estimate.hpp"

namespace limbcast::filters {

/// One estimate for each of `rows`, from the estimates of a filter's epochs.
///
/// Between two epochs: cubic Hermite of positions and velocities, attitude along the shorter arc,
/// and the fill kind of what was measured: the row that an epoch falls on has the epoch's, the rows
/// between are inertial. Where inertial readings were missing (epochs more than 50 ms apart, or
/// before and after all of them) and the markers are no more than 0.1 s apart: the polynomial fill
/// of the markers. Where nothing is known: kNone.
///
/// The 1-sigma of a polynomial fill is 1 mm + 5 m/s² · h²/32, h the length of the gap in the
/// markers: what a limb can do in it unseen.
///
/// @param estimates, rows, markers  in the order of their times; markers only where seen.
[[nodiscard]] std::vector<PositionEstimate> SeriesAt(std::span<const PositionEstimate> estimates,
                                                     std::span<const Time> rows,
                                                     std::span<const SeenMarker> markers);

}  // namespace limbcast::filters
