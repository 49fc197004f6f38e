#pragma once

#include <span>

#include "common/base/result.hpp"
#include "common/filters/filter_settings.hpp"

namespace limbcast::filters {

/// Tuning of the inertial + optical position filter. Defaults: design/position.md sections 3 and 4;
/// where they differ the field says so.
struct OpticalInertialConfig {
  /// Covariance and corrections run once for at least this time; position, velocity and attitude
  /// run at the full inertial rate. Range: [0.001, 0.05].
  double block_s = 0.005;
  /// Fixed lag. At least the longest expected gap + 0.3 s, or the middle of a gap is only as good
  /// as the forward filter. Range: [0, 5].
  double lag_s = 0.5;

  /// White noise of the inertial unit. Range: (0, 10], (0, 1].
  double sigma_accel_m_s2_rthz = 0.01;
  double sigma_gyro_rad_s_rthz = 1e-3;
  /// Random walk of the biases. Range: [0, 1].
  double walk_accel_bias_m_s3_rthz = 1e-3;
  double walk_gyro_bias_rad_s2_rthz = 1e-4;
  /// Gauss–Markov time constants of the biases (thesis 4.10, 4.11); 0 = random walk. Range: [0,
  /// 1e6].
  double tau_accel_bias_s = 0.0;
  double tau_gyro_bias_s = 0.0;
  /// Noise in proportion to acceleration and rate: what scale, misalignment and bandwidth errors
  /// are left. Range: [0, 1].
  double k_accel = 0.01;
  double k_rate = 0.003;
  /// Noise in proportion to the second difference of a reading: how much of a shock (a tap, a heel
  /// strike) falls between two samples. Not in the specification. Range: [0, 10].
  double k_accel_bend = 0.1;
  double k_rate_bend = 0.1;

  /// Marker noise, and jitter of its stamp. Range: (0, 0.1], [0, 0.1].
  double sigma_marker_m = 0.15e-3;
  double sigma_marker_time_s = 0.15e-3;

  /// What is estimated beside position, velocity, attitude and biases; otherwise what is given
  /// holds.
  bool estimate_lever_arm = true;
  bool estimate_gravity = true;
  bool estimate_time_offset = true;
  /// Scale and misalignment of accelerometer and gyro (18 states).
  bool estimate_calibration = true;
  /// How much later than the accelerometer the gyro is. Not in the specification.
  bool estimate_gyro_delay = true;

  /// Lever arm r from the inertial unit to the marker, sensor axes. Range: [-1, 1].
  double lever_arm_x_m = 0.0;
  double lever_arm_y_m = 0.0;
  double lever_arm_z_m = 0.0;
  /// How far the optical stamps lead. Range: [-0.1, 0.1].
  double marker_lead_s = 0.0;
  /// How much later than the accelerometer the gyro is. Range: [-0.05, 0.05].
  double gyro_delay_s = 0.0;
  /// Range: [9, 10].
  double gravity_m_s2 = 9.81;

  /// Standard deviations at the start. Range: (0, ...]; those of what may be given: [0, ...].
  double sigma_start_p_m = 0.01;
  double sigma_start_v_m_s = 0.1;
  double sigma_start_tilt_rad = 0.035;
  double sigma_start_heading_rad = 0.175;
  double sigma_start_accel_bias_m_s2 = 0.05;
  double sigma_start_gyro_bias_rad_s = 0.00524;
  double sigma_start_lever_m = 0.03;
  double sigma_start_gravity_tilt_rad = 0.035;
  double sigma_start_gravity_m_s2 = 0.02;
  double sigma_start_marker_lead_s = 0.01;
  double sigma_start_gyro_delay_s = 0.003;
  double sigma_start_accel_matrix = 0.01;
  double sigma_start_gyro_matrix = 0.01;

  /// Full scales: at 98 % a reading counts as saturated; 0 = only by the sample's flags. Range: [0,
  /// 1e4].
  double accel_range_m_s2 = 0.0;
  double gyro_range_rad_s = 0.0;
};

[[nodiscard]] std::span<const SettingField<OpticalInertialConfig>> OpticalInertialFields();
[[nodiscard]] Status Validate(const OpticalInertialConfig& config);

}  // namespace limbcast::filters
