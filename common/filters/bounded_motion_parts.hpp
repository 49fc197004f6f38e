#pragma once

// What the two source files of BoundedMotionCore share; nobody else includes it.

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
inline constexpr int kMagnetic[6] = {2, kBm, kBm + 1, kBm + 2, kM0, kM0 + 1};

inline constexpr double kMaxGyroBias_rad_s = 2.0 * 3.14159265358979323846 / 180.0;
inline constexpr double kRestLowPass_s = 0.5;
inline constexpr double kRestGyro_rad_s = 2.0 * 3.14159265358979323846 / 180.0;
inline constexpr double kRestAccel_m_s2 = 0.5;
inline constexpr double kMaxCarriedVariance = 4.0;
inline constexpr std::uint32_t kSymmetriseEvery = 16;

template <typename Scalar>
Eigen::Quaternion<Scalar> Exp(const Eigen::Matrix<Scalar, 3, 1>& phi) {
  const Scalar theta2 = phi.squaredNorm();
  // Series to θ⁴: below 0.3 rad its error is under 4e-9 relative, above that the closed form.
  Scalar w;
  Scalar s;
  if (theta2 < Scalar(1e-2)) {
    w = Scalar(1) - theta2 * (Scalar(1) / 8 - theta2 * (Scalar(1) / 384 - theta2 / 46080));
    s = Scalar(0.5) - theta2 * (Scalar(1) / 48 - theta2 * (Scalar(1) / 3840 - theta2 / 645120));
  } else {
    const Scalar theta = std::sqrt(theta2);
    w = std::cos(Scalar(0.5) * theta);
    s = std::sin(Scalar(0.5) * theta) / theta;
  }
  return {w, s * phi.x(), s * phi.y(), s * phi.z()};
}

template <typename Scalar>
Eigen::Matrix<Scalar, 3, 3> Skew(const Eigen::Matrix<Scalar, 3, 1>& a) {
  Eigen::Matrix<Scalar, 3, 3> a_x;
  a_x << 0, -a.z(), a.y(), a.z(), 0, -a.x(), -a.y(), a.x(), 0;
  return a_x;
}

}  // namespace bounded_motion

/// Means over one slow step of length T.
template <typename Scalar>
struct BoundedMotionCore<Scalar>::Means {
  Scalar T;
  Matrix3 R;
  Vector3 f;  // specific force in E, bias removed
  Vector3 m;  // field in E, units of m_ref
  Scalar w2;
  bool has_f;
  bool has_m;
  Vector3 m_b;  // m without the carried field
};

}  // namespace limbcast::filters
