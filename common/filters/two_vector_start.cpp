// Notation: E earth (ENU), S sensor; rows of R are the earth axes in sensor coordinates.
#include "common/filters/two_vector_start.hpp"

#include <cmath>

#include "common/math/rotation.hpp"

namespace limbcast::filters {
namespace {

constexpr double kMinAccel_m_s2 = 1e-6;
constexpr double kMinSine = 1e-6;

}  // namespace

std::optional<Eigen::Quaterniond> OrientationFromTwoVectors(const Eigen::Vector3d& accel_m_s2,
                                                            const Eigen::Vector3d& mag) {
  const double accel_norm = accel_m_s2.norm();
  const double mag_norm = mag.norm();
  if (!(accel_norm >= kMinAccel_m_s2) || !(mag_norm > 0.0)) {
    return std::nullopt;
  }
  const Eigen::Vector3d up_S = accel_m_s2 / accel_norm;
  const Eigen::Vector3d east_S = (mag / mag_norm).cross(up_S);
  const double sine = east_S.norm();
  if (!(sine >= kMinSine)) {
    return std::nullopt;
  }
  Eigen::Matrix3d R_ES;
  R_ES.row(0) = east_S.transpose() / sine;
  R_ES.row(1) = up_S.cross(east_S).transpose() / sine;
  R_ES.row(2) = up_S.transpose();
  return math::QuaternionFromMatrix(R_ES);
}

std::optional<Eigen::Quaterniond> OrientationFromUpright(const Eigen::Vector3d& accel_m_s2) {
  const double norm = accel_m_s2.norm();
  if (!(norm >= kMinAccel_m_s2)) {
    return std::nullopt;
  }
  const Eigen::Vector3d up_S = accel_m_s2 / norm;
  // Half-way quaternion (1 + u·z, u × z); upside down every horizontal axis would do: take x.
  const Eigen::Quaterniond half(1.0 + up_S.z(), up_S.y(), -up_S.x(), 0.0);
  if (half.norm() < 1e-8) {
    return Eigen::Quaterniond(0.0, 1.0, 0.0, 0.0);
  }
  return half.normalized();
}

Eigen::Vector3d ReferenceField(const Eigen::Vector3d& mag_in_earth) {
  return {0.0, std::hypot(mag_in_earth.x(), mag_in_earth.y()), mag_in_earth.z()};
}

void TwoVectorStart::Add(const Eigen::Vector3d& gyro_rad_s, double dt_s,
                         const Eigen::Vector3d* accel_m_s2, const Eigen::Vector3d* mag_tesla) {
  state_.q_first_sensor = (state_.q_first_sensor * math::ExpSO3(gyro_rad_s * dt_s)).normalized();
  state_.time_s += dt_s;
  if (accel_m_s2 != nullptr) {
    state_.sum_accel_m_s2 += state_.q_first_sensor * *accel_m_s2;
    state_.accel_count += 1.0;
  }
  if (mag_tesla != nullptr) {
    state_.sum_mag_tesla += state_.q_first_sensor * *mag_tesla;
    state_.mag_count += 1.0;
  }
}

std::optional<TwoVectorStart::Start> TwoVectorStart::Solve() const {
  if (state_.accel_count == 0.0) {
    return std::nullopt;
  }
  const Eigen::Vector3d accel_m_s2 = state_.sum_accel_m_s2 / state_.accel_count;
  Start start;
  start.has_field = state_.mag_count > 0.0;
  std::optional<Eigen::Quaterniond> q_earth_first;
  if (start.has_field) {
    const Eigen::Vector3d mag_tesla = state_.sum_mag_tesla / state_.mag_count;
    q_earth_first = OrientationFromTwoVectors(accel_m_s2, mag_tesla);
    if (q_earth_first) {
      start.mag_in_earth_tesla = *q_earth_first * mag_tesla;
    }
  } else {
    q_earth_first = OrientationFromUpright(accel_m_s2);
  }
  if (!q_earth_first) {
    return std::nullopt;
  }
  start.q_earth_sensor = (*q_earth_first * state_.q_first_sensor).normalized();
  return start;
}

}  // namespace limbcast::filters
