#pragma once

#include <span>
#include <string>

#include "common/filters/position/offline_smoother.hpp"
#include "common/filters/position/position_estimate.hpp"

namespace limbcast::tool {

/// A line of column names and one for each estimate. Columns: time_s (from the recording's first
/// sample), fill (none, measured, inertial_smoothed, inertial_forward, polynomial), degraded (0,
/// 1), sigma_position_m (1-sigma of the 3-D error of the marker's position),
/// p_earth_marker_{x,y,z}_m, p_earth_sensor_{x,y,z}_m, v_earth_sensor_{x,y,z}_m_s,
/// accel_in_earth_{x,y,z}_m_s2 (gravity removed), q_earth_sensor_{w,x,y,z}. Earth is the optical
/// system's frame. Cells of what is not known are empty: all but time and fill for `none`, and
/// velocity, acceleration and attitude where inertia had no part.
[[nodiscard]] std::string PositionCsv(std::span<const filters::PositionEstimate> estimates);

/// What was found on the way, a few lines for a person: lever arm, time offsets, markers used.
[[nodiscard]] std::string SmoothSummary(const filters::OfflineResult& result);

}  // namespace limbcast::tool
