#pragma once

#include <Eigen/Core>
#include <optional>
#include <span>

#include "common/base/time.hpp"

namespace limbcast::filters {

/// A marker position that was seen.
struct SeenMarker {
  Time at{};
  Eigen::Vector3d p_earth_marker_m = Eigen::Vector3d::Zero();
};

/// Position and velocity at one end of a gap.
struct GapEnd {
  Time at{};
  Eigen::Vector3d p_m = Eigen::Vector3d::Zero();
  Eigen::Vector3d v_m_s = Eigen::Vector3d::Zero();
};

/// The end of a gap at `at` from the markers within `window_s` on one side of it: a parabola by
/// least squares; a line with four or fewer, and the marker itself with zero velocity when it is
/// alone.
///
/// @param before  true: markers up to `at` are used; false: markers from `at` on.
/// @returns nothing without a marker in the window.
[[nodiscard]] std::optional<GapEnd> FitGapEnd(std::span<const SeenMarker> markers, Time at,
                                              bool before, double window_s = 0.15);

/// Cubic Hermite curve between two ends (design/position.md section 5): what fills gaps up to 0.1 s
/// without inertial readings. Also the spline that inertial fills are compared with.
///
/// @param at  between the ends.
[[nodiscard]] Eigen::Vector3d HermiteFill(const GapEnd& from, const GapEnd& to, Time at);

}  // namespace limbcast::filters
