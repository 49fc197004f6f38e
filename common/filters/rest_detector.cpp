#include "common/filters/rest_detector.hpp"

#include <algorithm>
#include <numbers>

namespace limbcast::filters {
namespace {

constexpr double kLowPass_s = 0.5;
constexpr double kStillGyro_rad_s = 2.0 * std::numbers::pi / 180.0;
constexpr double kStillAccel_m_s2 = 0.5;

}  // namespace

void RestDetector::Update(const Eigen::Vector3d& gyro_rad_s, const Eigen::Vector3d& accel_m_s2,
                          const Eigen::Vector3d& gyro_bias_rad_s, double dt_s) {
  if (!state_.started) {
    state_.low_gyro_rad_s = gyro_rad_s;
    state_.low_accel_m_s2 = accel_m_s2;
    state_.started = true;
  }
  const double gain = std::min(dt_s * (1.0 / kLowPass_s), 1.0);
  state_.low_gyro_rad_s += gain * (gyro_rad_s - state_.low_gyro_rad_s);
  state_.low_accel_m_s2 += gain * (accel_m_s2 - state_.low_accel_m_s2);
  constexpr double kGyro2 = kStillGyro_rad_s * kStillGyro_rad_s;
  constexpr double kAccel2 = kStillAccel_m_s2 * kStillAccel_m_s2;
  const bool still = (gyro_rad_s - state_.low_gyro_rad_s).squaredNorm() < kGyro2 &&
                     (accel_m_s2 - state_.low_accel_m_s2).squaredNorm() < kAccel2 &&
                     (state_.low_gyro_rad_s - gyro_bias_rad_s).squaredNorm() < kGyro2;
  state_.still_s = still ? state_.still_s + dt_s : 0.0;
}

}  // namespace limbcast::filters
