#pragma once

#include <Eigen/Core>

#include "common/filters/position/inertial_mechanisation.hpp"

namespace limbcast::filters {

/// Where the states of one inertial unit stand in an error vector: first index of each block of
/// three (matrices: of nine, by columns), −1 when there is none.
struct InertialStates {
  int p = -1;
  int v = -1;
  int theta = -1;
  int accel_bias = -1;
  int gyro_bias = -1;
  int gravity = -1;
  int accel_matrix = -1;
  int gyro_matrix = -1;
  int gyro_delay = -1;  ///< one element
};

/// Noise of one inertial unit (design/position.md section 3).
struct InertialNoise {
  double sigma_accel_m_s2_rthz = 0.01;
  double sigma_gyro_rad_s_rthz = 1e-3;
  double walk_accel_bias_m_s3_rthz = 1e-3;
  double walk_gyro_bias_rad_s2_rthz = 1e-4;
  double k_accel = 0.01;      ///< of |a|: scale, misalignment, bandwidth
  double k_rate = 0.003;      ///< of |w|
  double k_accel_bend = 0.1;  ///< of |f_k − 2 f_{k−1} + f_{k−2}|: what happened between samples
  double k_rate_bend = 0.1;     ///< of |w_k − 2 w_{k−1} + w_{k−2}|
  double tau_accel_bias_s = 0;  ///< Gauss–Markov time constants; 0 = random walk
  double tau_gyro_bias_s = 0;
};

/// The rows of p, v and θ of the transition of one unit over a block of length D, for error states
/// true minus estimate, θ in the earth frame (R_true = Exp(θ) R):
///
///   p' = p + D v − D²/2 [Rf]× θ − D²/2 R b_a + D²/2 g + D³/6 [Rf]× R b_g
///   v' = v − D [Rf]× θ − D R b_a + D g + D²/2 [Rf]× R b_g
///   θ' = θ − D R b_g
///   M_a(i,j): v −= D R(:,i) f_m(j), p −= D²/2 R(:,i) f_m(j);   M_g(i,j): θ −= D R(:,i) w_m(j),
///   v += D²/2 [Rf]× R(:,i) w_m(j), p += D³/6 [Rf]× R(:,i) w_m(j)
///   t_g: θ += Σ R Δw ,  v −= D/2 [Rf]× Σ R Δw ,  p −= D²/6 [Rf]× Σ R Δw
///
/// Design/position.md section 3, and the attitude coupling of M_g that follows from its b_g terms;
/// t_g is the gyro delay of AdvanceInertial.
///
/// @param sign  +1; −1 for a unit whose acceleration is subtracted (a moving source). p and v rows
///              then get the negative of all but the identity and D v.
/// @param top   rows of the transition; only the entries named above are written, the caller sets
///              it to zero (or identity) before.
void AddInertialTransition(const InertialBlock& block, const InertialStates& states, double sign,
                           Eigen::Ref<Eigen::MatrixXd, 0, Eigen::OuterStride<>> top);

/// Process noise that a block adds, each axis.
struct InertialProcessNoise {
  double var_v = 0.0;      ///< (m/s)²; with cov_pv and var_p the white-noise integral
  double cov_pv = 0.0;     ///< = var_v D/2
  double var_p = 0.0;      ///< = var_v D²/3
  double var_theta = 0.0;  ///< rad²
  double var_accel_bias = 0.0;
  double var_gyro_bias = 0.0;
};

/// Noise over the block (design/position.md section 3), with the motion-proportional terms and one
/// more, for what a sampled sensor cannot say of a shock:
///
///   var_v = sa² D + (ka |a| D)² + Σ (kb |f_k − 2 f_{k−1} + f_{k−2}| dt)² ,
///   var_θ = sg² D + (kw |w| D)² + Σ (kb |w_k − 2 w_{k−1} + w_{k−2}| dt)²
///
/// A line through neighbouring samples says nothing against the trapezoid rule; a bend says that
/// something happened in less than two sampling intervals, and how large it was nobody saw.
///
/// @param accel_in_earth_m_s2  mean acceleration over the block, gravity removed.
/// @param inflation            1; larger after dropouts and saturation, multiplies the variances of
///                             v and θ.
[[nodiscard]] InertialProcessNoise ProcessNoiseOf(const InertialBlock& block,
                                                  const InertialNoise& noise,
                                                  const Eigen::Vector3d& accel_in_earth_m_s2,
                                                  double inflation);

/// P += Q, for the states of one unit.
void AddProcessNoise(const InertialProcessNoise& noise, const InertialStates& states,
                     Eigen::Ref<Eigen::MatrixXd, 0, Eigen::OuterStride<>> P);

}  // namespace limbcast::filters
