#pragma once

#include <Eigen/Geometry>

#include "common/base/position_kind.hpp"
#include "common/base/time.hpp"

namespace limbcast::fusion {

/// Where a position track has its sensor, at the sample it was given last.
struct SegmentPosition {
  Eigen::Vector3d p_earth_sensor_m = Eigen::Vector3d::Zero();
  Eigen::Vector3d v_earth_sensor_m_s = Eigen::Vector3d::Zero();
  Eigen::Matrix3d cov_position_m2 = Eigen::Matrix3d::Zero();
  FillKind fill = FillKind::kNone;
};

/// Where it had it some time ago, by all that has come since.
struct LaggedPosition {
  Time measured_at{};
  Eigen::Quaterniond q_earth_sensor = Eigen::Quaterniond::Identity();
  SegmentPosition position;
};

}  // namespace limbcast::fusion
