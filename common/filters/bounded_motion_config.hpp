#pragma once

#include <cstdint>
#include <span>

#include "common/base/result.hpp"
#include "common/filters/filter_settings.hpp"

namespace limbcast::filters {

enum class BoundedMotionPrecision : std::uint8_t { kDouble = 0, kFloat = 1 };

/// Tuning of the bounded-motion filter (BMF). The defaults suit a hand- or body-worn MARG sensor at
/// 25–1000 Hz with a factory-calibrated gyro. Fields are in units of the reference field where the
/// name says `_ref`.
struct BoundedMotionConfig {
  /// Arithmetic of the core; single precision gives the same mean error and is faster.
  BoundedMotionPrecision precision = BoundedMotionPrecision::kDouble;

  /// Rate of the covariance and of all corrections; the attitude is integrated at the sample rate.
  /// Range: [5, 100].
  double slow_rate_hz = 14.0;
  /// Time over which the first orientation is averaged. Range: [0, 10].
  double init_time_s = 0.5;
  /// The output is predicted this far ahead with the current rate, to make up for a known latency
  /// of the sensor. Its reports are causal all the same. Range: [-0.1, 0.1].
  double output_lead_s = 0.0;

  /// White gyro noise density. Range: (0, 1].
  double sigma_gyro_rad_s_rthz = 2e-4;
  /// Rate-proportional gyro noise: adds (k |w|)² per second to the attitude variance. Range: [0,
  /// 1].
  double k_rate_rts = 3e-4;
  /// Random walk and initial std of the gyro bias. Range: [0, 1].
  double walk_gyro_bias_rad_s_rts = 1e-4;
  double sigma_gyro_bias_start_rad_s = 0.01;
  /// Random walk and initial std of the nine gyro scale and misalignment errors; raise the second
  /// to 0.005–0.01 for an uncalibrated gyro, 0 switches the estimation off. Range: [0, 0.1].
  double walk_gyro_matrix_rts = 1e-6;
  double sigma_gyro_matrix_start = 0.002;

  /// White accelerometer noise density. Range: (0, 10].
  double sigma_accel_m_s2_rthz = 0.01;
  /// Random walk and initial std of the accelerometer bias. Range: [0, 10].
  double walk_accel_bias_m_s2_rts = 1e-4;
  double sigma_accel_bias_start_m_s2 = 0.03;
  /// Strength of "the velocity stays near zero"; small is strong, infinity switches it off
  /// (vehicles). Range: (0, ∞].
  double velocity_bound_m_s_rts = 0.5;
  /// Strength of "the position stays near zero". Range: (0, ∞].
  double position_bound_m_rts = 0.8;

  /// White magnetometer noise density. Range: (0, 10].
  double sigma_mag_ref_rts = 0.05;
  /// How much of the field's heading-free deviation is added to that noise. An inhomogeneous field
  /// with amplitude σ that stays alike for a time τ acts on heading like white noise of density
  /// σ√(2τ): this is √(2τ), τ ≈ 6 s. Range: [0, 10].
  double k_deviation_rts = 3.5;
  /// Time for which a deviation is remembered. Range: (0, 10].
  double deviation_hold_s = 1.5;
  /// Random walk and initial std of the reference field (north and up): a field that was distorted
  /// when the filter started, or differs from place to place, is learned and no longer taken for
  /// heading. 0 = the reference of the start stands. Range: [0, 1].
  double walk_reference_ref_rts = 0.005;
  double sigma_reference_start_ref = 0.03;
  /// A mean deviation above the threshold opens the covariance of the carried field. Range: [0,
  /// 100].
  double carried_jump_ref_rts = 15.0;
  double carried_jump_threshold_ref = 0.15;
  double carried_jump_time_s = 0.3;
  /// Random walk and initial std of the field carried with the sensor. Range: [0, 1].
  double walk_carried_field_ref_rts = 5e-6;
  double sigma_carried_field_start_ref = 5e-4;
  /// Normalised innovation squared above which the magnetometer's noise is raised to fit. Range:
  /// [3, 1e6].
  double gate_nis = 25.0;

  /// At rest: std of the gyro reading as bias, and of the zero velocity. Range: (0, 1].
  double sigma_rest_rad_s_rts = 0.001;
  double sigma_zero_velocity_m_s = 0.01;
  /// Initial std of tilt and heading. Range: (0, 3].
  double sigma_tilt_start_rad = 0.1;
  double sigma_heading_start_rad = 0.1;
};

/// The same filter without the guard against learning in a distorted field: a fixed reference and a
/// noise that hardly depends on the deviation (design study; "bmf-plain"). For comparison.
[[nodiscard]] BoundedMotionConfig PlainBoundedMotionConfig();

/// The fields by name, with their ranges.
[[nodiscard]] std::span<const SettingField<BoundedMotionConfig>> BoundedMotionFields();
[[nodiscard]] Status Validate(const BoundedMotionConfig& config);

}  // namespace limbcast::filters
