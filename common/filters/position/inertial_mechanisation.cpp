#include "common/filters/position/inertial_mechanisation.hpp"

#include "common/math/rotation.hpp"

namespace limbcast::filters {

// Notation: E earth, S sensor; q_ES, R_ES turn S coordinates into E.

Eigen::Vector3d AdvanceInertial(const InertialReading& before, const InertialReading& now,
                                double dt_s, const InertialErrors& errors,
                                const Eigen::Vector3d& g_in_earth_m_s2, NavigationState& state,
                                InertialBlock& block) {
  const InertialReading r0 = errors.Correct(before);
  const InertialReading r1 = errors.Correct(now);
  const Eigen::Vector3d phi_rad = 0.5 * dt_s * (r0.gyro_rad_s + r1.gyro_rad_s) +
                                  dt_s * dt_s / 12.0 * r0.gyro_rad_s.cross(r1.gyro_rad_s) +
                                  errors.gyro_delay_s * (r1.gyro_rad_s - r0.gyro_rad_s);
  const Eigen::Matrix3d R0_ES = state.q_earth_sensor.toRotationMatrix();
  state.q_earth_sensor = (state.q_earth_sensor * math::ExpSO3(phi_rad)).normalized();
  const Eigen::Matrix3d R1_ES = state.q_earth_sensor.toRotationMatrix();
  const Eigen::Vector3d f0_E = R0_ES * r0.accel_m_s2;
  const Eigen::Vector3d f1_E = R1_ES * r1.accel_m_s2;
  const Eigen::Vector3d a0_E = f0_E + g_in_earth_m_s2;
  Eigen::Vector3d a1_E = f1_E + g_in_earth_m_s2;
  state.p_earth_sensor_m +=
      dt_s * state.v_earth_sensor_m_s + dt_s * dt_s * (a0_E / 3.0 + a1_E / 6.0);
  state.v_earth_sensor_m_s += 0.5 * dt_s * (a0_E + a1_E);

  block.dt_s += dt_s;
  ++block.steps;
  block.sum_gyro_change_in_earth += 0.5 * (R0_ES + R1_ES) * (r1.gyro_rad_s - r0.gyro_rad_s);
  block.sum_R += 0.5 * dt_s * (R0_ES + R1_ES);
  block.sum_force_in_earth += 0.5 * dt_s * (f0_E + f1_E);
  block.sum_accel_raw += 0.5 * dt_s * (before.accel_m_s2 + now.accel_m_s2);
  block.sum_gyro_raw += 0.5 * dt_s * (before.gyro_rad_s + now.gyro_rad_s);
  const Eigen::Vector3d accel_change = now.accel_m_s2 - before.accel_m_s2;
  const Eigen::Vector3d gyro_change = now.gyro_rad_s - before.gyro_rad_s;
  block.sum_accel_bend2 += dt_s * dt_s * (accel_change - block.accel_change).squaredNorm();
  block.sum_gyro_bend2 += dt_s * dt_s * (gyro_change - block.gyro_change).squaredNorm();
  block.accel_change = accel_change;
  block.gyro_change = gyro_change;
  return a1_E;
}

}  // namespace limbcast::filters
