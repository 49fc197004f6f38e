#pragma once

// The motion half of BoundedMotionStep; what instantiates it includes it, nobody else.
// Notation: E earth (ENU), S sensor; q_ES and R turn S into E. Symbols as in the header's error
// vector.

#include "common/filters/bounded_motion_core.hpp"
#include "common/filters/bounded_motion_parts.hpp"
#include "common/filters/filter_constants.hpp"

namespace limbcast::filters {
using namespace bounded_motion;  // NOLINT: the names of one class, shared by its source files

template <typename Scalar>
void BoundedMotionStep<Scalar>::ResetCovariance() {
  const auto square = [](double sigma) { return static_cast<Scalar>(sigma * sigma); };
  state_.P.SetZero();
  state_.P(0, 0) = state_.P(1, 1) = square(config_.sigma_tilt_start_rad);
  state_.P(2, 2) = square(config_.sigma_heading_start_rad);
  for (int i = 0; i < 3; ++i) {
    state_.P(kBg + i, kBg + i) = square(config_.sigma_gyro_bias_start_rad_s);
    state_.P(kBa + i, kBa + i) = square(config_.sigma_accel_bias_start_m_s2);
    state_.P(kBm + i, kBm + i) = square(config_.sigma_carried_field_start_ref);
  }
  for (int i = 0; i < 2; ++i) {
    state_.P(kV + i, kV + i) = Scalar(1e-2);
    state_.P(kP + i, kP + i) = Scalar(1e-2);
    state_.P(kM0 + i, kM0 + i) = square(config_.sigma_reference_start_ref);
  }
  for (int i = 0; i < 9; ++i) {
    state_.P(kS + i, kS + i) = square(config_.sigma_gyro_matrix_start);
  }
}

template <typename Scalar>
void BoundedMotionStep<Scalar>::ClearSums() {
  state_.sum_R.setZero();
  state_.sum_f.setZero();
  state_.sum_m.setZero();
  state_.sum_W.setZero();
  state_.sum_w2 = Scalar(0);
  state_.sum_t = Scalar(0);
  state_.sum_extra_theta = Scalar(0);
  state_.n = Scalar(0);
  state_.n_f = Scalar(0);
  state_.n_m = Scalar(0);
}

template <typename Scalar>
void BoundedMotionStep<Scalar>::Update(const Input& input) {
  const Mask present = lanes::IsSet(input.present);
  if (lanes::All(present)) {
    DetectRest(input);
    Integrate(input);
  } else {
    BoundedMotionFastState<Scalar>& fast = state_;
    const BoundedMotionFastState<Scalar> before = fast;
    DetectRest(input);
    Integrate(input);
    lanes::KeepWhereNot<Scalar>(present, before, fast);
  }
  const Scalar period_s = static_cast<Scalar>(1.0 / config_.slow_rate_hz);
  const Mask due(lanes::Both(present, state_.sum_t > period_s - Scalar(0.5) * input.dt_s));
  if (lanes::All(due)) {
    SlowStep();
  } else if (lanes::Any(due)) {
    const State before = state_;
    SlowStep();
    lanes::KeepWhereNot<Scalar>(due, before, state_);
  }
}

template <typename Scalar>
void BoundedMotionStep<Scalar>::Integrate(const Input& input) {
  State& s = state_;
  const Vector3 w_raw = input.gyro_rad_s - s.b_g;
  s.w_ES_S = w_raw - s.S * w_raw;
  s.q_ES = s.q_ES * Exp<Scalar>(s.w_ES_S * input.dt_s);
  // One Newton step towards |q| = 1: the exponential leaves it there but for rounding.
  s.q_ES.coeffs() *= Scalar(1.5) - Scalar(0.5) * s.q_ES.squaredNorm();
  const Matrix3 R = s.q_ES.toRotationMatrix();

  s.sum_R += R;
  for (int j = 0; j < 3; ++j) {
    s.sum_W.template middleCols<3>(3 * j) += (input.dt_s * w_raw[j]) * R;
  }
  s.sum_w2 += w_raw.squaredNorm();
  s.sum_t += input.dt_s;
  s.n += Scalar(1);
  const Mask accel_valid = lanes::IsSet(input.accel_valid);
  const Mask mag_valid = lanes::IsSet(input.mag_valid);
  if (lanes::Any(accel_valid)) {
    s.sum_f = Choose<Scalar>(accel_valid, s.sum_f + R * (input.accel_m_s2 - s.b_a), s.sum_f);
    s.n_f += input.accel_valid;
  }
  if (lanes::Any(mag_valid)) {
    s.sum_m = Choose<Scalar>(mag_valid, s.sum_m + R * input.mag, s.sum_m);
    s.n_m += input.mag_valid;
  }
}

template <typename Scalar>
void BoundedMotionStep<Scalar>::DetectRest(const Input& input) {
  State& s = state_;
  const Mask judged(lanes::Both(lanes::IsSet(input.accel_valid), lanes::IsSet(input.rest_allowed)));
  if (!lanes::Any(judged)) {
    s.rest_time_s = Scalar(0);
    return;
  }
  const Mask started = lanes::IsSet(s.low_started);
  Vector3 low_g = Choose<Scalar>(started, s.low_g, input.gyro_rad_s);
  Vector3 low_a = Choose<Scalar>(started, s.low_a, input.accel_m_s2);
  const Scalar gain = input.dt_s / (static_cast<Scalar>(kRestLowPass_s) + input.dt_s);
  low_g += gain * (input.gyro_rad_s - low_g);
  low_a += gain * (input.accel_m_s2 - low_a);
  const auto kGyro2 = static_cast<Scalar>(kRestGyro_rad_s * kRestGyro_rad_s);
  const auto kAccel2 = static_cast<Scalar>(kRestAccel_m_s2 * kRestAccel_m_s2);
  const Mask steady(lanes::Both(Vector3(input.gyro_rad_s - low_g).squaredNorm() < kGyro2,
                                Vector3(input.accel_m_s2 - low_a).squaredNorm() < kAccel2));
  const Mask still(lanes::Both(steady, Vector3(low_g - s.b_g).squaredNorm() < kGyro2));
  s.low_g = Choose<Scalar>(judged, low_g, s.low_g);
  s.low_a = Choose<Scalar>(judged, low_a, s.low_a);
  s.low_started = lanes::Select(judged, Scalar(1), s.low_started);
  s.rest_time_s =
      lanes::Select(lanes::Both(judged, still), Scalar(s.rest_time_s + input.dt_s), Scalar(0));
}

template <typename Scalar>
void BoundedMotionStep<Scalar>::SlowStep() {
  State& s = state_;
  Means means;
  means.T = s.sum_t;
  means.R = s.sum_R / s.n;
  means.has_f = s.n_f > Scalar(0);
  means.has_m = lanes::Both(s.n_m > Scalar(0), lanes::IsSet(s.has_field));
  means.f = Choose<Scalar>(means.has_f, s.sum_f / s.n_f,
                           Vector3(Scalar(0), Scalar(0), Scalar(kGravity_m_s2)));
  means.m = Choose<Scalar>(means.has_m, s.sum_m / (s.n_m * s.m_ref), Vector3::Zero());
  means.w2 = s.sum_w2 / s.n;

  s.P.ToFull(P_);
  P_.row(kDim).setZero();
  const Scalar T = means.T;
  s.p_h += T * s.v_h + (Scalar(0.5) * T * T) * means.f.template head<2>();
  s.v_h += T * means.f.template head<2>();
  Propagate(means);
  if (lanes::Any(AtRest())) {
    CorrectRest(T);
  }
  CorrectBounds(T);
  if (lanes::Any(means.has_m)) {
    CheckField(means);
    means.m_b = means.m - means.R * s.b_m;
    CorrectField(means);
  }
  ClearSums();
  s.slow_steps += Scalar(1);
  s.P.FromFull(P_);
  GuardCovariance();
}

// P ← F P Fᵀ + Q. With M = P Fᵀ, rows of F M outside {δθ, δv, δp} are those of M, and by symmetry
// the columns are their transposes; only the 7×7 block of those three needs F applied from the
// left.
template <typename Scalar>
void BoundedMotionStep<Scalar>::Propagate(const Means& means) {
  State& s = state_;
  auto& P = P_;
  const Scalar T = means.T;
  const Eigen::Matrix<Scalar, 2, 3> V_theta = -T * Skew<Scalar>(means.f).template topRows<2>();
  const Eigen::Matrix<Scalar, 2, 3> V_ba = -T * means.R.template topRows<2>();
  const Matrix3 Th_bg = -T * means.R;
  const Eigen::Matrix<Scalar, 3, 9>& W = s.sum_W;

  // M = P Fᵀ: columns, in the order that uses old values
  for (int i = 0; i < 2; ++i) {
    P.col(kP + i) += T * P.col(kV + i);
  }
  for (int i = 0; i < 2; ++i) {
    P.col(kV + i) += V_theta(i, 0) * P.col(0) + V_theta(i, 1) * P.col(1) +
                     V_theta(i, 2) * P.col(2) + V_ba(i, 0) * P.col(kBa) +
                     V_ba(i, 1) * P.col(kBa + 1) + V_ba(i, 2) * P.col(kBa + 2);
  }
  for (int i = 0; i < 3; ++i) {
    auto column = P.col(kTheta + i);
    column +=
        Th_bg(i, 0) * P.col(kBg) + Th_bg(i, 1) * P.col(kBg + 1) + Th_bg(i, 2) * P.col(kBg + 2);
    column -= W(i, 0) * P.col(kS) + W(i, 1) * P.col(kS + 1) + W(i, 2) * P.col(kS + 2);
    column -= W(i, 3) * P.col(kS + 3) + W(i, 4) * P.col(kS + 4) + W(i, 5) * P.col(kS + 5);
    column -= W(i, 6) * P.col(kS + 6) + W(i, 7) * P.col(kS + 7) + W(i, 8) * P.col(kS + 8);
  }
  // F M on the block {δθ, δv, δp}
  constexpr int kChanged[7] = {0, 1, 2, kV, kV + 1, kP, kP + 1};
  for (const int c : kChanged) {
    auto column = P.col(c);
    column.template segment<2>(kP) += T * column.template segment<2>(kV);
    column.template segment<2>(kV) +=
        V_theta * column.template segment<3>(kTheta) + V_ba * column.template segment<3>(kBa);
    column.template segment<3>(kTheta) +=
        Th_bg * column.template segment<3>(kBg) - W * column.template segment<9>(kS);
  }
  // the other columns' rows of that block, by symmetry
  constexpr int kOther[20] = {3,  4,  5,  10, 11, 12, 13, 14, 15, 16,
                              17, 18, 19, 20, 21, 22, 23, 24, 25, 26};
  for (const int c : kOther) {
    for (const int r : kChanged) {
      P(r, c) = P(c, r);
    }
  }

  const auto add = [&P, T](int first, int count, double sigma) {
    const Scalar variance = static_cast<Scalar>(sigma * sigma) * T;
    for (int i = first; i < first + count; ++i) {
      P(i, i) += variance;
    }
  };
  const Scalar k2 = static_cast<Scalar>(config_.k_rate_rts * config_.k_rate_rts);
  for (int i = 0; i < 3; ++i) {
    P(i, i) += k2 * means.w2 * T + s.sum_extra_theta;
  }
  add(kTheta, 3, config_.sigma_gyro_rad_s_rthz);
  add(kBg, 3, config_.walk_gyro_bias_rad_s_rts);
  add(kV, 2, config_.sigma_accel_m_s2_rthz);
  // Without accelerometer in this step the horizontal acceleration is anything a limb does (about 5
  // m/s²).
  const Scalar unseen = lanes::Select(means.has_f, Scalar(0), Scalar(Scalar(25) * T * T));
  for (int i = kV; i < kV + 2; ++i) {
    P(i, i) += unseen;
  }
  add(kBa, 3, config_.walk_accel_bias_m_s2_rts);
  add(kBm, 3, config_.walk_carried_field_ref_rts);
  add(kS, 9, config_.walk_gyro_matrix_rts);
  add(kM0, 2, config_.walk_reference_ref_rts);
}

}  // namespace limbcast::filters
