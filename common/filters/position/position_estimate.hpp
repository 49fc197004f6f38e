#pragma once

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "common/base/position_kind.hpp"
#include "common/base/time.hpp"

namespace limbcast::filters {

using limbcast::FillKind;

/// Position, velocity and attitude of an inertial unit, and of the marker on it, at one time.
/// Frame: that of the optical system.
struct PositionEstimate {
  Time at{};
  FillKind fill = FillKind::kNone;
  bool degraded = false;   ///< inertial readings were missing or saturated on the way here
  bool has_motion = true;  ///< false: only p_earth_marker_m is known, without inertial readings
  Eigen::Vector3d p_earth_sensor_m = Eigen::Vector3d::Zero();
  Eigen::Vector3d v_earth_sensor_m_s = Eigen::Vector3d::Zero();
  Eigen::Vector3d accel_in_earth_m_s2 = Eigen::Vector3d::Zero();  ///< gravity removed
  Eigen::Quaterniond q_earth_sensor = Eigen::Quaterniond::Identity();
  Eigen::Vector3d p_earth_marker_m = Eigen::Vector3d::Zero();  ///< comparable with the optical one
  Eigen::Matrix3d cov_position_m2 = Eigen::Matrix3d::Zero();

  /// 1-sigma of the 3-D position error.
  [[nodiscard]] double sigma_position_m() const {
    return std::sqrt(std::max(0.0, cov_position_m2.trace()));
  }
};

}  // namespace limbcast::filters
