#pragma once

// What the source files of BoundedMotionCore share; nobody else includes it.

#include <Eigen/Geometry>
#include <cmath>
#include <cstdint>

#include "common/filters/bounded_motion_core.hpp"

namespace limbcast::filters {
namespace bounded_motion {

inline constexpr int kTheta = 0;
inline constexpr int kBg = 3;
inline constexpr int kV = 6;
inline constexpr int kP = 8;
inline constexpr int kBa = 10;
inline constexpr int kBm = 13;
inline constexpr int kS = 16;
inline constexpr int kM0 = 25;

inline constexpr double kMaxGyroBias_rad_s = 2.0 * 3.14159265358979323846 / 180.0;
inline constexpr double kMaxAccelBias_m_s2 = 0.5;  // 50 mg: a sensor beyond that is broken
inline constexpr double kRestLowPass_s = 0.5;
inline constexpr double kRestGyro_rad_s = 2.0 * 3.14159265358979323846 / 180.0;
inline constexpr double kRestAccel_m_s2 = 0.5;
inline constexpr double kMaxCarriedVariance = 4.0;

template <typename Scalar>
inline Eigen::Quaternion<Scalar> Exp(const Eigen::Matrix<Scalar, 3, 1>& phi) {
  const Scalar theta2 = phi.squaredNorm();
  // Series to θ⁶: below 0.1 rad its error is under 1e-15, above that the closed form.
  Scalar w = Scalar(1) - theta2 * (Scalar(1.0 / 8) -
                                   theta2 * (Scalar(1.0 / 384) - theta2 * Scalar(1.0 / 46080)));
  Scalar s = Scalar(0.5) - theta2 * (Scalar(1.0 / 48) -
                                     theta2 * (Scalar(1.0 / 3840) - theta2 * Scalar(1.0 / 645120)));
  const lanes::MaskOf<Scalar> large(!(theta2 < Scalar(1e-2)));
  if (lanes::Any(large)) {
    const Scalar theta = lanes::Sqrt(theta2);
    const Scalar half = Scalar(0.5) * theta;
    const Scalar sine = lanes::Map(half, [](auto a) { return std::sin(a); });
    w = lanes::Select(large, lanes::Map(half, [](auto a) { return std::cos(a); }), w);
    s = lanes::Select(large, Scalar(sine / theta), s);
  }
  return {w, Scalar(s * phi.x()), Scalar(s * phi.y()), Scalar(s * phi.z())};
}

/// e^(−T/τ).
template <typename Scalar>
inline Scalar Decay(Scalar T, Scalar tau) {
  return lanes::Map(Scalar(-T / tau), [](auto a) { return std::exp(a); });
}

/// `a` where the mask is set, `b` elsewhere, coefficient by coefficient.
template <typename Scalar, typename A, typename B>
inline auto Choose(lanes::MaskOf<Scalar> mask, const Eigen::MatrixBase<A>& a,
                   const Eigen::MatrixBase<B>& b) {
  Eigen::Matrix<Scalar, A::RowsAtCompileTime, A::ColsAtCompileTime> chosen = a;
  const Eigen::Matrix<Scalar, A::RowsAtCompileTime, A::ColsAtCompileTime> other = b;
  for (Eigen::Index i = 0; i < chosen.size(); ++i) {
    chosen.data()[i] = lanes::Select(mask, chosen.data()[i], other.data()[i]);
  }
  return chosen;
}

template <typename Scalar>
inline Eigen::Matrix<Scalar, 3, 3> Skew(const Eigen::Matrix<Scalar, 3, 1>& a) {
  Eigen::Matrix<Scalar, 3, 3> a_x;
  const Scalar zero(0);
  a_x << zero, -a.z(), a.y(), a.z(), zero, -a.x(), -a.y(), a.x(), zero;
  return a_x;
}

}  // namespace bounded_motion

/// Means over one slow step of length T.
template <typename Scalar>
struct BoundedMotionStep<Scalar>::Means {
  Scalar T;
  Matrix3 R;
  Vector3 f;  // specific force in E, bias removed
  Vector3 m;  // field in E, units of m_ref
  Scalar w2;
  Mask has_f;
  Mask has_m;
  Vector3 m_b;  // m without the carried field
};

}  // namespace limbcast::filters
