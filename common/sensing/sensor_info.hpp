#pragma once

#include <Eigen/Core>
#include <string>

#include "common/base/ids.hpp"
#include "common/base/time.hpp"

namespace limbcast::sensing {

/// What is known of one sensor (state topic: a late joiner gets the last one).
struct SensorInfo {
  SensorUid sensor_uid;
  std::string driver;  ///< at most 32 characters
  std::string serial;  ///< at most 64 characters
  std::string label;   ///< what a person calls it; at most 64 characters
  double rate_hz = 0.0;
  float gyro_range_rad_s = 0.0F;  ///< full scale; 0 = unknown
  float accel_range_m_s2 = 0.0F;
  float mag_range_tesla = 0.0F;        ///< 0 = unknown or no magnetometer
  float gyro_noise_rad_s_rthz = 0.0F;  ///< white noise density; 0 = unknown
  float accel_noise_m_s2_rthz = 0.0F;
  float mag_noise_tesla_rthz = 0.0F;
  std::string calibration;  ///< name of the calibration in force, "" = none; at most 64 characters
  Time calibrated_at{};
};

}  // namespace limbcast::sensing
