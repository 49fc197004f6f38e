#pragma once

#include <Eigen/Core>
#include <optional>

#include "common/base/result.hpp"
#include "common/filters/position/coil_pose_solver.hpp"
#include "common/filters/position/inertial_error_model.hpp"
#include "common/filters/position/soft_update.hpp"
#include "common/sensing/coil_field.hpp"

namespace limbcast::filters {

/// Tuning of CoilInertialFilter; defaults of design/position.md sections 3, 9 and 10. Without
/// `estimate_calibration`, `estimate_gyro_delay` and `estimate_gradient` it is the filter of
/// section 10.
struct CoilInertialConfig {
  sensing::CoilSource source;
  InertialNoise inertial;  ///< of both units
  /// Scale and misalignment of the sensor's accelerometer and gyro (18 states).
  bool estimate_calibration = true;
  /// How much later than the accelerometer the sensor's gyro is.
  bool estimate_gyro_delay = true;
  /// The gradient of the background (5 states) and an offset of the source's magnetometer (3). The
  /// field at the source then says what it is at the sensor, so that the source's magnetometer is
  /// used between pulses; without the gradient it is not.
  bool estimate_gradient = true;

  /// With tones (CoilTones): what a pulse is with pulses. Range: [0.05, 2]
  double tone_window_s = 0.2;

  /// Noise of one magnetometer sample, one axis. Range: [1e-10, 1e-5]
  double sigma_mag_tesla = 50e-9;
  /// Of the coil's field: what the model does not say (winding, calibration). Range: [0, 0.2]
  double relative_field_error = 0.01;
  /// Random walk of the background field; about gradient times speed. Range: [0, 1e-4]
  double walk_background_tesla_rts = 0.3e-6;
  /// What is left of that walk when the gradient is estimated: the field at the source changes with
  /// the source's motion only, and that is the slower one. Range: [0, 1]
  double walk_beside_gradient = 0.3;
  /// Random walk of the gradient, as a part of that of the background, each metre. Range: [0, 10]
  double walk_gradient_per_m = 0.3;
  /// What scale and misalignment of the magnetometer make of the background while the sensor turns:
  /// a walk of this part of it in one radian. Range: [0, 0.1]
  double mag_calibration_error = 2e-3;
  int iterations = 3;     ///< of the update. Range: [1, 10]
  double max_step = 0.3;  ///< of |p|, in one update. Range: (0, 1]
  SoftGateConfig gate;

  /// The source's own magnetometer counts so long after the last of its coils settled: it is among
  /// them, where what is left of a pulse is a thousand times as strong. Range: [0, 1]
  double emitter_quiet_s = 0.015;

  /// Gauge pinning: the source's accelerometer shows gravity, the background stays what it was.
  double sigma_gravity_m_s2 = 8.0;         ///< of one sample. Range: [0.1, 100]
  double gravity_period_s = 0.1;           ///< samples between are taken as one. Range: [0, 10]
  double sigma_background_tesla = 1.5e-6;  ///< Range: [1e-8, 1e-3]
  double background_period_s = 0.5;        ///< Range: [0, 10]

  /// Half of the emitter's axes in which the sensor is at a start (unit vector); without it the
  /// filter begins at p or at −p, and motion has to tell which (CoilBothSides).
  std::optional<Eigen::Vector3d> half_space;
  /// No start so close to the plane between the halves. Range: [0, 1.5]
  double half_space_boundary_rad = 0.35;
  CoilPoseConfig pose;

  // Standard deviations at a start.
  double start_sigma_v_m_s = 0.3;  ///< at a re-acquisition
  double rest_sigma_v_m_s = 0.03;  ///< at the first start
  double start_sigma_tilt_rad = 0.035;
  double start_sigma_accel_bias_m_s2 = 0.05;
  double start_sigma_gyro_bias_rad_s = 5.2e-3;
  double start_sigma_background_tesla = 1e-6;
  double start_sigma_gradient_tesla_m = 0.5e-6;          ///< each element. Range: [0, 1e-4]
  double start_sigma_emitter_mag_offset_tesla = 0.5e-6;  ///< Range: [0, 1e-4]
  /// Of each element; without unit. Range: [0, 0.1]
  double start_sigma_accel_matrix = 0.01;
  double start_sigma_gyro_matrix = 0.01;
  double start_sigma_gyro_delay_s = 0.003;  ///< Range: [0, 0.05]
  double rest_s = 0.25;                     ///< mean of so long gives the first attitudes
  double rest_below_rad_s = 0.2;            ///< of both gyros
  /// Without rest for so long anything will do for the first attitudes; a track that begins so may
  /// be wrong for some seconds.
  double rest_patience_s = 2.0;

  /// A pose this uncertain begins a track: its covariance goes with it.
  double acquire_sigma_m = 0.35;

  // Loss of track.
  double lost_nis = 9.0;  ///< mean NIS/3 over three pulses
  /// Mean NIS/3 of the first samples of four pulses: what the estimate said before the pulse pulled
  /// at it. Below 1.3 in the tracks of 120 simulated subjects, now and then above 6 in real fast
  /// motion; 5 to 20 on the wrong side. Range: [1, 1e6]
  double lost_first_nis = 12.0;
  double lost_relative_sigma = 0.25;  ///< √(tr P_pp) over |p|
  double lost_range_m = 1.5;
  double longest_hold_s = 0.05;  ///< inertial readings held for so long
};

/// The first range that is not kept.
[[nodiscard]] Status Validate(const CoilInertialConfig& config);

}  // namespace limbcast::filters
