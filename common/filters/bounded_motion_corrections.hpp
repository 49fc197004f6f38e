#pragma once

// The corrections of BoundedMotionStep: what the slow step learns from rest, bounds and field. What
// instantiates it includes it, nobody else. Notation as in bounded_motion_motion.hpp.

#include <cmath>
#include <limits>

#include "common/filters/bounded_motion_core.hpp"
#include "common/filters/bounded_motion_parts.hpp"

namespace limbcast::filters {
using namespace bounded_motion;  // NOLINT: the names of one class, shared by its source files

template <typename Scalar>
void BoundedMotionStep<Scalar>::CheckField(const Means& means) {
  State& s = state_;
  const Scalar T = means.T;
  const Vector3 m_b = means.m - means.R * s.b_m;
  // Heading-free: the norm and the vertical part do not depend on heading.
  const Scalar in_norm = m_b.norm() - s.m_0.norm();
  const Scalar in_vertical = m_b.z() - s.m_0.z();
  const Scalar deviation = lanes::Sqrt(Scalar(in_norm * in_norm + in_vertical * in_vertical));
  const Scalar held = lanes::Max(
      deviation, s.deviation_hold * Decay(T, static_cast<Scalar>(config_.deviation_hold_s)));
  const Scalar mean =
      s.deviation_mean + (Scalar(1) - Decay(T, static_cast<Scalar>(config_.carried_jump_time_s))) *
                             (deviation - s.deviation_mean);
  s.deviation_hold = lanes::Select(means.has_m, held, s.deviation_hold);
  s.deviation_mean = lanes::Select(means.has_m, mean, s.deviation_mean);
  // At rest the same place is seen again and again, which says nothing about others.
  // A plain mean over the first `scatter_time_s` of motion, fading from then on.
  const Mask moving(lanes::Both(means.has_m, !AtRest()));
  const Scalar moving_s = lanes::Select(moving, T, Scalar(0));
  s.scatter_s =
      lanes::Min(Scalar(s.scatter_s + moving_s), static_cast<Scalar>(config_.scatter_time_s));
  const Scalar share = moving_s / lanes::Max(s.scatter_s, T);
  s.east_mean += share * (m_b.x() - s.east_mean);
  const Scalar off_mean = m_b.x() - s.east_mean;
  s.east_scatter2 += share * (off_mean * off_mean - s.east_scatter2);
  const Mask jumped(
      lanes::Both(means.has_m, mean > static_cast<Scalar>(config_.carried_jump_threshold_ref)));
  if (lanes::Any(jumped)) {
    const Scalar step = static_cast<Scalar>(config_.carried_jump_ref_rts) * mean;
    for (int i = kBm; i < kBm + 3; ++i) {
      const Scalar opened =
          lanes::Min(Scalar(P_(i, i) + step * step * T), static_cast<Scalar>(kMaxCarriedVariance));
      P_(i, i) = lanes::Select(jumped, opened, P_(i, i));
    }
  }
}

// z observes the N neighbouring error states from `first` directly, each with the same variance.
// Where the mask is not set, nothing changes.
template <typename Scalar>
template <int N>
void BoundedMotionStep<Scalar>::CorrectDirect(Mask where, int first,
                                              const Eigen::Matrix<Scalar, N, 1>& z,
                                              Scalar variance) {
  auto& P = P_;
  const Eigen::Matrix<Scalar, kRows, N> D = P.template middleCols<N>(first);
  Eigen::Matrix<Scalar, N, N> innovation = D.template middleRows<N>(first);
  innovation.diagonal().array() += variance;
  const Eigen::Matrix<Scalar, N, N> inverse = innovation.inverse();
  Eigen::Matrix<Scalar, kRows, N> K = D * inverse;
  if (!lanes::All(where)) {
    K = Choose<Scalar>(where, K, Eigen::Matrix<Scalar, kRows, N>::Zero());
  }
  for (int c = 0; c < kDim; ++c) {
    P.col(c).noalias() -= K * D.row(c).transpose();
  }
  Inject(K * z);
}

template <typename Scalar>
void BoundedMotionStep<Scalar>::CorrectRest(Scalar T) {
  const auto square = [](double sigma) { return static_cast<Scalar>(sigma * sigma); };
  CorrectDirect<2>(AtRest(), kV, -state_.v_h, square(config_.sigma_zero_velocity_m_s));
  const Vector3 turn_rad_s = state_.low_g - state_.b_g;
  // Nobody turns slowly for long: the longer the rest, the less of it can be a turn.
  const Scalar rested_s = lanes::Max(state_.rest_time_s, Scalar(kRestAfter_s));
  const Scalar persistence_s = static_cast<Scalar>(config_.rest_turn_persistence_s) *
                               lanes::Sqrt(Scalar(Scalar(kRestAfter_s) / rested_s));
  CorrectDirect<3>(AtRest(), kBg, turn_rad_s,
                   (square(config_.sigma_rest_rad_s_rts) +
                    Scalar(2) * persistence_s * turn_rad_s.squaredNorm()) /
                       T);
}

template <typename Scalar>
void BoundedMotionStep<Scalar>::CorrectBounds(Scalar T) {
  if (std::isfinite(config_.velocity_bound_m_s_rts)) {
    const auto r = static_cast<Scalar>(config_.velocity_bound_m_s_rts);
    CorrectDirect<2>(Mask(true), kV, -state_.v_h, r * r / T);
  }
  if (std::isfinite(config_.position_bound_m_rts)) {
    const auto r = static_cast<Scalar>(config_.position_bound_m_rts);
    const auto persistence_s = static_cast<Scalar>(config_.position_persistence_s);
    CorrectDirect<2>(Mask(true), kP, -state_.p_h,
                     (r * r + Scalar(2) * persistence_s * state_.p_h.squaredNorm()) / T);
  }
}

// z = m_b − m_0, H_θ = [m_b×], H_bm = R̄, H_m0 = (e_y, e_z). The magnetometer must not tilt the
// estimate: the gain rows of δθ_x and δθ_y are zero; by default so are those of all that gravity
// and rest can teach, which leaves heading, carried field and reference (kMagnetic). With the
// arbitrary-gain form P − K Dᵀ − D Kᵀ + K Σ Kᵀ (D = P Hᵀ) everything but the block of the states
// without gain, which stays, comes out as in the optimal update (S. F. Schmidt, "Application of
// state-space methods to navigation problems", 1966).
template <typename Scalar>
void BoundedMotionStep<Scalar>::CorrectField(const Means& means) {
  State& s = state_;
  auto& P = P_;
  const Vector3 z = means.m_b - s.m_0;
  const Matrix3 H_theta = Skew<Scalar>(means.m_b);
  const Matrix3& H_bm = means.R;
  Eigen::Matrix<Scalar, kRows, 3> D = P.template middleCols<3>(kTheta) * H_theta.transpose() +
                                      P.template middleCols<3>(kBm) * H_bm.transpose();
  D.template rightCols<2>() += P.template middleCols<2>(kM0);
  Matrix3 innovation =
      H_theta * D.template middleRows<3>(kTheta) + H_bm * D.template middleRows<3>(kBm);
  innovation.template bottomRows<2>() += D.template middleRows<2>(kM0);
  const auto k_R = static_cast<Scalar>(config_.k_deviation_rts);
  const auto r_m = static_cast<Scalar>(config_.sigma_mag_ref_rts);
  const auto floor = static_cast<Scalar>(config_.scatter_floor_ref);
  const Scalar spread2 = s.deviation_hold * s.deviation_hold +
                         lanes::Max(Scalar(s.east_scatter2 - floor * floor), Scalar(0));
  innovation.diagonal().array() += (r_m * r_m + k_R * k_R * spread2) / means.T;
  Matrix3 inverse = innovation.inverse();
  const Scalar nis = z.dot(inverse * z);
  const auto gate = static_cast<Scalar>(config_.gate_nis);
  inverse *= lanes::Select(Mask(nis > gate), Scalar(gate / nis), Scalar(1));
  Eigen::Matrix<Scalar, kRows, 3> K_optimal = D * inverse;
  if (!lanes::All(means.has_m)) {
    K_optimal = Choose<Scalar>(means.has_m, K_optimal, Eigen::Matrix<Scalar, kRows, 3>::Zero());
  }
  Eigen::Matrix<Scalar, kRows, 3> K = K_optimal;
  if (config_.mag_heading_only) {
    constexpr int kMagnetic[6] = {2, kBm, kBm + 1, kBm + 2, kM0, kM0 + 1};
    K.setZero();
    for (const int a : kMagnetic) {
      K.row(a) = K_optimal.row(a);
      P.col(a).noalias() -= K_optimal * D.row(a).transpose();
    }
    for (const int a : kMagnetic) {
      for (int c = 0; c < kDim; ++c) {
        P(a, c) = P(c, a);
      }
    }
  } else {
    const Eigen::Matrix<Scalar, 2, 2> tilt = P.template topLeftCorner<2, 2>();
    for (int c = 0; c < kDim; ++c) {
      P.col(c).noalias() -= K_optimal * D.row(c).transpose();
    }
    P.template topLeftCorner<2, 2>() = tilt;
    K.template topRows<2>().setZero();
  }
  Inject(K * z);
}

template <typename Scalar>
void BoundedMotionStep<Scalar>::Inject(const Eigen::Matrix<Scalar, kRows, 1>& dx) {
  State& s = state_;
  s.q_ES = Exp<Scalar>(dx.template segment<3>(kTheta)) * s.q_ES;
  s.east_mean -= s.m_0.y() * dx(2);  // the mean turns with the heading it was seen in
  const auto bounded = [](Scalar value, double most) {
    return lanes::Min(lanes::Max(value, Scalar(-most)), Scalar(most));
  };
  for (int i = 0; i < 3; ++i) {
    s.b_g[i] = bounded(Scalar(s.b_g[i] + dx[kBg + i]), kMaxGyroBias_rad_s);
    s.b_a[i] = bounded(Scalar(s.b_a[i] + dx[kBa + i]), kMaxAccelBias_m_s2);
  }
  s.v_h += dx.template segment<2>(kV);
  s.p_h += dx.template segment<2>(kP);
  s.b_m += dx.template segment<3>(kBm);
  s.m_0.template tail<2>() += dx.template segment<2>(kM0);
  for (int j = 0; j < 3; ++j) {
    s.S.col(j) += dx.template segment<3>(kS + 3 * j);
  }
}

template <typename Scalar>
void BoundedMotionStep<Scalar>::GuardCovariance() {
  State& s = state_;
  const auto most = Scalar(std::numeric_limits<lanes::NumberOf<Scalar>>::max());
  Mask sound(true);
  for (int i = 0; i < kDim; ++i) {
    sound = lanes::Both(sound,
                        lanes::Both(s.P(i, i) >= Scalar(0), s.P(i, i) <= most));  // false for NaN
  }
  if (!lanes::All(sound)) {
    const auto before = s.P;
    ResetCovariance();
    for (std::size_t i = 0; i < s.P.upper.size(); ++i) {
      s.P.upper[i] = lanes::Select(sound, before.upper[i], s.P.upper[i]);
    }
    s.covariance_resets += lanes::Select(sound, Scalar(0), Scalar(1));
  }
}

}  // namespace limbcast::filters
