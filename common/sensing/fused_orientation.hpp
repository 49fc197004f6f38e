#pragma once

#include <Eigen/Geometry>
#include <cstdint>

#include "common/base/ids.hpp"
#include "common/base/time.hpp"
#include "common/base/tracking.hpp"

namespace limbcast::sensing {

/// A reading of a sensor that has its own orientation filter on board.
struct FusedOrientation {
  SensorUid sensor_uid;
  std::uint32_t sequence = 0;
  std::uint32_t flags = 0;  ///< MargFlag bits; kGyroMissing and kAccelMissing apply
  Time measured_at{};
  Time published_at{};
  Eigen::Quaterniond q_earth_sensor = Eigen::Quaterniond::Identity();
  HeadingReference heading = HeadingReference::kArbitrary;
  Eigen::Vector3f gyro_rad_s = Eigen::Vector3f::Zero();
  Eigen::Vector3f accel_m_s2 = Eigen::Vector3f::Zero();  ///< specific force, sensor axes
  float sigma_rad = 0.0F;  ///< 1-sigma of the orientation as the sensor states it; 0 = not stated
};

}  // namespace limbcast::sensing
