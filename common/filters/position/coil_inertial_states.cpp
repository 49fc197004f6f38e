#include "common/filters/position/coil_inertial_states.hpp"

#include <cmath>

#include "common/math/rotation.hpp"

namespace limbcast::filters {

using Index = CoilInertialIndex;

Eigen::Matrix3d GradientOf(const Eigen::Matrix<double, 5, 1>& e) {
  Eigen::Matrix3d G;
  G << e[0], e[2], e[3],  //
      e[2], e[1], e[4],   //
      e[3], e[4], -e[0] - e[1];
  return G;
}

Eigen::Matrix<double, 5, 1> GradientElements(const Eigen::Matrix3d& G) {
  return {G(0, 0), G(1, 1), G(0, 1), G(0, 2), G(1, 2)};
}

bool CoilInertialState::IsFinite() const {
  return p_earth_m.allFinite() && v_earth_m_s.allFinite() && q_earth_sensor.coeffs().allFinite() &&
         q_earth_emitter.coeffs().allFinite() && sensor.gyro_bias_rad_s.allFinite() &&
         sensor.accel_bias_m_s2.allFinite() && emitter.gyro_bias_rad_s.allFinite() &&
         emitter.accel_bias_m_s2.allFinite() && background_earth_tesla.allFinite() &&
         gradient_earth_tesla_m.allFinite() && emitter_mag_offset_tesla.allFinite() &&
         sensor.accel_matrix.allFinite() && sensor.gyro_matrix.allFinite() &&
         std::isfinite(sensor.gyro_delay_s);
}

CoilInertialState Plus(const CoilInertialState& state, const CoilVector& d) {
  CoilInertialState x = state;
  x.p_earth_m += d.segment<3>(Index::kP);
  x.v_earth_m_s += d.segment<3>(Index::kV);
  x.q_earth_sensor =
      (math::ExpSO3(d.segment<3>(Index::kSensorTheta)) * x.q_earth_sensor).normalized();
  x.q_earth_emitter =
      (math::ExpSO3(d.segment<3>(Index::kEmitterTheta)) * x.q_earth_emitter).normalized();
  x.sensor.accel_bias_m_s2 += d.segment<3>(Index::kSensorAccelBias);
  x.sensor.gyro_bias_rad_s += d.segment<3>(Index::kSensorGyroBias);
  x.emitter.accel_bias_m_s2 += d.segment<3>(Index::kEmitterAccelBias);
  x.emitter.gyro_bias_rad_s += d.segment<3>(Index::kEmitterGyroBias);
  x.background_earth_tesla += d.segment<3>(Index::kBackground);
  x.sensor.accel_matrix += d.segment<9>(Index::kSensorAccelMatrix).reshaped(3, 3);
  x.sensor.gyro_matrix += d.segment<9>(Index::kSensorGyroMatrix).reshaped(3, 3);
  x.sensor.gyro_delay_s += d[Index::kSensorGyroDelay];
  x.gradient_earth_tesla_m += GradientOf(d.segment<5>(Index::kGradient));
  x.emitter_mag_offset_tesla += d.segment<3>(Index::kEmitterMagOffset);
  return x;
}

CoilVector Minus(const CoilInertialState& x, const CoilInertialState& y) {
  CoilVector d;
  d.segment<3>(Index::kP) = x.p_earth_m - y.p_earth_m;
  d.segment<3>(Index::kV) = x.v_earth_m_s - y.v_earth_m_s;
  d.segment<3>(Index::kSensorTheta) = math::LogSO3(x.q_earth_sensor * y.q_earth_sensor.conjugate());
  d.segment<3>(Index::kEmitterTheta) =
      math::LogSO3(x.q_earth_emitter * y.q_earth_emitter.conjugate());
  d.segment<3>(Index::kSensorAccelBias) = x.sensor.accel_bias_m_s2 - y.sensor.accel_bias_m_s2;
  d.segment<3>(Index::kSensorGyroBias) = x.sensor.gyro_bias_rad_s - y.sensor.gyro_bias_rad_s;
  d.segment<3>(Index::kEmitterAccelBias) = x.emitter.accel_bias_m_s2 - y.emitter.accel_bias_m_s2;
  d.segment<3>(Index::kEmitterGyroBias) = x.emitter.gyro_bias_rad_s - y.emitter.gyro_bias_rad_s;
  d.segment<3>(Index::kBackground) = x.background_earth_tesla - y.background_earth_tesla;
  d.segment<9>(Index::kSensorAccelMatrix) =
      (x.sensor.accel_matrix - y.sensor.accel_matrix).reshaped();
  d.segment<9>(Index::kSensorGyroMatrix) = (x.sensor.gyro_matrix - y.sensor.gyro_matrix).reshaped();
  d[Index::kSensorGyroDelay] = x.sensor.gyro_delay_s - y.sensor.gyro_delay_s;
  d.segment<5>(Index::kGradient) =
      GradientElements(x.gradient_earth_tesla_m - y.gradient_earth_tesla_m);
  d.segment<3>(Index::kEmitterMagOffset) = x.emitter_mag_offset_tesla - y.emitter_mag_offset_tesla;
  return d;
}

void SetVariance(CoilCovariance& P, int first, const Eigen::Vector3d& sigma) {
  P.middleRows<3>(first).setZero();
  P.middleCols<3>(first).setZero();
  P.diagonal().segment<3>(first) = sigma.cwiseAbs2();
}

void SetVariance(CoilCovariance& P, int first, double sigma) {
  SetVariance(P, first, Eigen::Vector3d::Constant(sigma));
}

void SetMatrixVariance(CoilCovariance& P, int first, double sigma) {
  for (int column = first; column < first + 9; column += 3) {
    SetVariance(P, column, sigma);
  }
}

}  // namespace limbcast::filters
