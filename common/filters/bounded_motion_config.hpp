#pragma once

#include <span>

#include "common/base/result.hpp"
#include "common/filters/filter_settings.hpp"
#include "common/filters/precision.hpp"

namespace limbcast::filters {

/// Tuning of the bounded-motion filter (BMF). The defaults suit a hand- or body-worn MARG sensor at
/// 25–1000 Hz with a factory-calibrated gyro. Fields are in units of the reference field where the
/// name says `_ref`.
struct BoundedMotionConfig {
  /// Arithmetic of the core; single precision gives the same mean error and is faster.
  Precision precision = Precision::kFloat;

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
  double sigma_gyro_matrix_start = 0.003;

  /// Accelerometer noise density: what is white, and what its scale errors and the turns within a
  /// slow step make of a moving limb's acceleration. Range: (0, 10].
  double sigma_accel_m_s2_rthz = 0.03;
  /// Random walk and initial std of the accelerometer bias. Range: [0, 10].
  double walk_accel_bias_m_s2_rts = 1e-4;
  double sigma_accel_bias_start_m_s2 = 0.03;
  /// Strength of "the velocity stays near zero"; small is strong, infinity switches it off
  /// (vehicles). Range: (0, ∞].
  double velocity_bound_m_s_rts = 0.5;
  /// Strength of "the position stays near zero". Range: (0, ∞].
  double position_bound_m_rts = 0.8;
  /// A position p that stays alike for a time τ (somebody walks away) acts on "stays near zero"
  /// like white noise of density |p|√(2τ), which is added. 0 = not. Range: [0, 100].
  double position_persistence_s = 2.0;

  /// White magnetometer noise density. Range: (0, 10].
  double sigma_mag_ref_rts = 0.02;
  /// The magnetometer corrects heading, carried and reference field only. Gyro bias and matrix,
  /// velocity, position and accelerometer bias are then "considered" (Schmidt): their uncertainty
  /// counts in its update, but only gravity and rest teach them, and a distorted field cannot.
  /// false = it corrects everything but tilt. Default: true.
  bool mag_heading_only = true;
  /// How much of the field's heading-free deviation is added to that noise. An inhomogeneous field
  /// with amplitude σ that stays alike for a time τ acts on heading like white noise of density
  /// σ√(2τ): this is √(2τ), τ ≈ 6 s. Range: [0, 10].
  double k_deviation_rts = 3.5;
  /// Time for which a deviation is remembered. Range: (0, 10].
  double deviation_hold_s = 1.5;
  /// The scatter of the field's east part about its own mean, over this time of motion, counts like
  /// a deviation: a place can turn the field and leave its length and dip alone, but not turn it
  /// everywhere alike. A wrong heading does not scatter. Range: (0, 1000].
  double scatter_time_s = 30.0;
  /// Scatter that an ordinary room has, and that counts as none (0.04 is 6° of heading where the
  /// dip is 67°). Infinity: scatter never counts. Range: (0, ∞].
  double scatter_floor_ref = 0.04;
  /// Random walk and initial std of the reference field (north and up): a field that was distorted
  /// when the filter started, or differs from place to place, is learned and no longer taken for
  /// heading. 0 = the reference of the start stands. Range: [0, 1].
  double walk_reference_ref_rts = 0.005;
  double sigma_reference_start_ref = 0.03;
  /// The session's field as measured before it (`limbcast calibrate session`): length and dip below
  /// the horizontal. A sensor whose field differs at the start is then beside iron, and its heading
  /// as doubtful as the difference allows. 0 = each sensor's own field at its start. Ranges: [0,
  /// 1e-3], [-1.57, 1.57].
  double reference_field_tesla = 0.0;
  double reference_dip_rad = 0.0;
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
  /// Whoever seems at rest may turn slowly. A rate w beside the known bias that stays alike for a
  /// time τ acts like white noise of density |w|√(2τ), which is added: a known bias is kept, an
  /// unknown one still learned. 0 = not. Range: [0, 100].
  double rest_turn_persistence_s = 1.0;
  /// Initial std of tilt and heading. Range: (0, 3].
  double sigma_tilt_start_rad = 0.1;
  double sigma_heading_start_rad = 0.1;

  /// How well the sensor's time stamps are known. An orientation that is late by this turns with
  /// the rate: only the reported covariance grows, by (σ ω)². Range: [0, 0.1].
  double sigma_time_s = 0.003;

  bool operator==(const BoundedMotionConfig&) const = default;
};

/// The same filter as the design study has it, without the guard against learning in a distorted
/// field ("bmf-plain"; see DESIGN-magnetic-guard.md). For comparison.
[[nodiscard]] BoundedMotionConfig PlainBoundedMotionConfig();

/// The fields by name, with their ranges.
[[nodiscard]] std::span<const SettingField<BoundedMotionConfig>> BoundedMotionFields();
[[nodiscard]] Status Validate(const BoundedMotionConfig& config);

}  // namespace limbcast::filters
