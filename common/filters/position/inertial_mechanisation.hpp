#pragma once

#include <Eigen/Geometry>

namespace limbcast::filters {

/// Position, velocity and attitude of a sensor by its own inertial readings.
struct NavigationState {
  Eigen::Vector3d p_earth_sensor_m = Eigen::Vector3d::Zero();
  Eigen::Vector3d v_earth_sensor_m_s = Eigen::Vector3d::Zero();
  Eigen::Quaterniond q_earth_sensor = Eigen::Quaterniond::Identity();
};

/// One inertial reading, sensor axes.
struct InertialReading {
  Eigen::Vector3d gyro_rad_s = Eigen::Vector3d::Zero();
  Eigen::Vector3d accel_m_s2 = Eigen::Vector3d::Zero();  ///< specific force
};

/// What is taken off the readings: w = w_m − b_g − M_g w_m, f = f_m − b_a − M_a f_m.
struct InertialErrors {
  Eigen::Vector3d gyro_bias_rad_s = Eigen::Vector3d::Zero();
  Eigen::Vector3d accel_bias_m_s2 = Eigen::Vector3d::Zero();
  Eigen::Matrix3d gyro_matrix = Eigen::Matrix3d::Zero();   ///< M_g
  Eigen::Matrix3d accel_matrix = Eigen::Matrix3d::Zero();  ///< M_a
  /// How much later than the accelerometer's the gyro's readings were true: their low-pass filters
  /// differ by a millisecond or two, and at 20 rad/s that is two degrees.
  double gyro_delay_s = 0.0;

  [[nodiscard]] InertialReading Correct(const InertialReading& reading) const {
    return {reading.gyro_rad_s - gyro_bias_rad_s - gyro_matrix * reading.gyro_rad_s,
            reading.accel_m_s2 - accel_bias_m_s2 - accel_matrix * reading.accel_m_s2};
  }
};

/// Sums over the inertial steps of one covariance block: what the error model of the block needs.
/// Thread-compatible.
struct InertialBlock {
  double dt_s = 0.0;
  int steps = 0;
  Eigen::Matrix3d sum_R = Eigen::Matrix3d::Zero();                     ///< ∫ R dt
  Eigen::Vector3d sum_force_in_earth = Eigen::Vector3d::Zero();        ///< ∫ R f dt, m/s
  Eigen::Vector3d sum_accel_raw = Eigen::Vector3d::Zero();             ///< ∫ f_m dt, m/s
  Eigen::Vector3d sum_gyro_raw = Eigen::Vector3d::Zero();              ///< ∫ w_m dt, rad
  Eigen::Vector3d sum_gyro_change_in_earth = Eigen::Vector3d::Zero();  ///< Σ R (w_k − w_{k−1})
  double sum_accel_bend2 = 0.0;  ///< Σ (|f_k − 2 f_{k−1} + f_{k−2}| dt)², (m/s)²
  double sum_gyro_bend2 = 0.0;   ///< the same of w, rad²
  // The last change of the readings; the only part that outlives a block.
  Eigen::Vector3d accel_change = Eigen::Vector3d::Zero();
  Eigen::Vector3d gyro_change = Eigen::Vector3d::Zero();

  /// Begins the next block.
  void Clear() {
    const InertialBlock last = *this;
    *this = {};
    accel_change = last.accel_change;
    gyro_change = last.gyro_change;
  }
};

/// One inertial step from the reading before to this one (design/position.md section 2, trapezoid):
///
///   R_k = R_{k−1} Exp(φ) ,  φ = dt (w_{k−1} + w_k)/2 + dt²/12 w_{k−1} × w_k + t_g (w_k − w_{k−1})
///   p += v dt + dt² (a0/3 + a1/6) ,  v += dt (a0 + a1)/2 ,  a = R f + g
///
/// The second term of φ is the Magnus term of a rate that changes its axis linearly over the step
/// (coning); the third brings readings that are late by t_g to the time of the accelerometer, to
/// first order (a late reading is w(t − t_g), its integral lacks t_g times the change). The
/// specification has neither.
///
/// @param before, now      readings as measured; `errors` are taken off here.
/// @param g_in_earth_m_s2  gravity, about (0, 0, −9.81).
/// @param block            gets the sums.
/// @returns the acceleration a at the end of the step, earth frame.
Eigen::Vector3d AdvanceInertial(const InertialReading& before, const InertialReading& now,
                                double dt_s, const InertialErrors& errors,
                                const Eigen::Vector3d& g_in_earth_m_s2, NavigationState& state,
                                InertialBlock& block);

}  // namespace limbcast::filters
