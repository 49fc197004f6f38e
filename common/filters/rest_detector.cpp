#include "common/filters/rest_detector.hpp"

namespace limbcast::filters {
namespace {

kernel::Vector<double> Plain(const Eigen::Vector3d& v) { return {v.x(), v.y(), v.z()}; }

}  // namespace

void RestDetector::Update(const Eigen::Vector3d& gyro_rad_s, const Eigen::Vector3d& accel_m_s2,
                          const Eigen::Vector3d& gyro_bias_rad_s, double dt_s) {
  kernel::UpdateRest(Plain(gyro_rad_s), Plain(accel_m_s2), Plain(gyro_bias_rad_s), dt_s, state_);
}

}  // namespace limbcast::filters
