#pragma once

#include <Eigen/Core>

#include "common/filters/position/backward_pass.hpp"
#include "common/filters/position/inertial_error_model.hpp"
#include "common/filters/position/inertial_mechanisation.hpp"
#include "common/math/rotation.hpp"

namespace limbcast::filters {

/// Error states of the inertial + optical filter, in the order of design/position.md section 3.
/// What is not to be estimated has a standard deviation of zero, and stays as it is.
namespace optical {
inline constexpr int kP = 0;
inline constexpr int kV = 3;
inline constexpr int kTheta = 6;
inline constexpr int kAccelBias = 9;
inline constexpr int kGyroBias = 12;
inline constexpr int kLever = 15;        ///< r, sensor frame, from the inertial unit to the marker
inline constexpr int kGravity = 18;      ///< g, optical frame
inline constexpr int kTimeOffset = 21;   ///< t_d, one element
inline constexpr int kAccelMatrix = 22;  ///< M_a by columns
inline constexpr int kGyroMatrix = 31;   ///< M_g by columns
inline constexpr int kGyroDelay = 40;    ///< t_g, one element; not in the specification
inline constexpr int kStates = 41;
inline constexpr int kMoving = 9;  ///< p, v, θ: the rows of the transition that mix
inline constexpr int kMarkerAxes = 3;

inline constexpr InertialStates kInertial{.p = kP,
                                          .v = kV,
                                          .theta = kTheta,
                                          .accel_bias = kAccelBias,
                                          .gyro_bias = kGyroBias,
                                          .gravity = kGravity,
                                          .accel_matrix = kAccelMatrix,
                                          .gyro_matrix = kGyroMatrix,
                                          .gyro_delay = kGyroDelay};

using ErrorVector = Eigen::Matrix<double, kStates, 1>;
using Covariance = Eigen::Matrix<double, kStates, kStates>;
using Transition = BlockTransition<kStates, kMoving>;
using Measurement = MeasurementRecord<kStates, kMarkerAxes>;
using Record = BackwardRecord<kStates, kMoving, kMarkerAxes>;
}  // namespace optical

/// The state X itself. Frame: the optical one, called earth; z is up to the gravity error that is
/// estimated with the rest.
struct OpticalInertialState {
  NavigationState navigation;
  InertialErrors errors;
  Eigen::Vector3d p_sensor_marker_m = Eigen::Vector3d::Zero();     ///< r
  Eigen::Vector3d g_in_earth_m_s2 = Eigen::Vector3d(0, 0, -9.81);  ///< g
  double marker_lead_s = 0.0;  ///< t_d; positive: the marker is where the sensor will be
};

/// X ⊞ d: adds; the attitude by Exp(d_θ) R.
inline void Inject(const optical::ErrorVector& d, OpticalInertialState& x) {
  using namespace optical;
  x.navigation.p_earth_sensor_m += d.segment<3>(kP);
  x.navigation.v_earth_sensor_m_s += d.segment<3>(kV);
  x.navigation.q_earth_sensor =
      (math::ExpSO3(d.segment<3>(kTheta)) * x.navigation.q_earth_sensor).normalized();
  x.errors.accel_bias_m_s2 += d.segment<3>(kAccelBias);
  x.errors.gyro_bias_rad_s += d.segment<3>(kGyroBias);
  x.p_sensor_marker_m += d.segment<3>(kLever);
  x.g_in_earth_m_s2 += d.segment<3>(kGravity);
  x.marker_lead_s += d[kTimeOffset];
  x.errors.accel_matrix += d.segment<9>(kAccelMatrix).reshaped(3, 3);
  x.errors.gyro_matrix += d.segment<9>(kGyroMatrix).reshaped(3, 3);
  x.errors.gyro_delay_s += d[kGyroDelay];
}

/// X ⊟ Y, the inverse: Y ⊞ (X ⊟ Y) = X.
inline optical::ErrorVector Difference(const OpticalInertialState& x,
                                       const OpticalInertialState& y) {
  using namespace optical;
  ErrorVector d;
  d.segment<3>(kP) = x.navigation.p_earth_sensor_m - y.navigation.p_earth_sensor_m;
  d.segment<3>(kV) = x.navigation.v_earth_sensor_m_s - y.navigation.v_earth_sensor_m_s;
  d.segment<3>(kTheta) =
      math::LogSO3(x.navigation.q_earth_sensor * y.navigation.q_earth_sensor.conjugate());
  d.segment<3>(kAccelBias) = x.errors.accel_bias_m_s2 - y.errors.accel_bias_m_s2;
  d.segment<3>(kGyroBias) = x.errors.gyro_bias_rad_s - y.errors.gyro_bias_rad_s;
  d.segment<3>(kLever) = x.p_sensor_marker_m - y.p_sensor_marker_m;
  d.segment<3>(kGravity) = x.g_in_earth_m_s2 - y.g_in_earth_m_s2;
  d[kTimeOffset] = x.marker_lead_s - y.marker_lead_s;
  d.segment<9>(kAccelMatrix) = (x.errors.accel_matrix - y.errors.accel_matrix).reshaped();
  d.segment<9>(kGyroMatrix) = (x.errors.gyro_matrix - y.errors.gyro_matrix).reshaped();
  d[kGyroDelay] = x.errors.gyro_delay_s - y.errors.gyro_delay_s;
  return d;
}

}  // namespace limbcast::filters
