#include "common/body/joint_heading.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>

#include "common/math/angles.hpp"
#include "common/math/rotation.hpp"

namespace limbcast::body {
namespace {

using Matrix6 = Eigen::Matrix<double, 6, 6>;
using Vector6 = Eigen::Matrix<double, 6, 1>;

constexpr double kPi = std::numbers::pi;
constexpr int kSteps = 120;  // of 3° around the circle; the minimum is tens of degrees wide
/// Sensors sit within this of the joint, and the constraint holds to kAccelError where skin moves.
constexpr double kLever_m = 0.4;
constexpr double kAccelError_m_s2 = 0.1;
/// Errors of neighbouring samples are one error: soft tissue swings at a few Hz.
constexpr double kCorrelation_s = 0.3;
constexpr double kMinWindow_s = 2.0;

/// Sums over the window from which the normal equations of every δ follow. With Z = Rz(δ) =
/// cos δ·P + sin δ·J + zzᵀ each product with Z in it is a sum of three.
struct Sums {
  std::size_t count = 0;
  Eigen::Matrix3d k1k1 = Eigen::Matrix3d::Zero();
  Eigen::Matrix3d k2k2 = Eigen::Matrix3d::Zero();
  Eigen::Vector3d k1a1 = Eigen::Vector3d::Zero();
  Eigen::Vector3d k2a2 = Eigen::Vector3d::Zero();
  double aa = 0.0;
  std::array<Eigen::Matrix3d, 3> k1zk2;
  std::array<Eigen::Vector3d, 3> k1za2;
  std::array<Eigen::Vector3d, 3> a1zk2;
  std::array<double, 3> a1za2{};

  Sums() {
    k1zk2.fill(Eigen::Matrix3d::Zero());
    k1za2.fill(Eigen::Vector3d::Zero());
    a1zk2.fill(Eigen::Vector3d::Zero());
  }
};

const std::array<Eigen::Matrix3d, 3>& TurnBasis() {
  static const std::array<Eigen::Matrix3d, 3> basis = [] {
    const Eigen::Vector3d z = Eigen::Vector3d::UnitZ();
    const Eigen::Matrix3d up = z * z.transpose();
    return std::array<Eigen::Matrix3d, 3>{Eigen::Matrix3d::Identity() - up, math::Skew(z), up};
  }();
  return basis;
}

/// K·R: what one metre of lever adds to the acceleration.
Eigen::Matrix3d LeverMatrix(const SmoothMotion& motion, std::size_t i) {
  const Eigen::Matrix3d w = math::Skew(motion.w_earth_sensor_in_earth_rad_s[i]);
  return (math::Skew(motion.alpha_in_earth_rad_s2[i]) + w * w) *
         motion.q_earth_sensor[i].toRotationMatrix();
}

Sums SumUp(const SmoothMotion& first, const SmoothMotion& second) {
  Sums sums;
  for (std::size_t i = 0; i < first.q_earth_sensor.size(); ++i) {
    const Eigen::Matrix3d k1 = LeverMatrix(first, i);
    const Eigen::Matrix3d k2 = LeverMatrix(second, i);
    const Eigen::Vector3d& a1 = first.accel_in_earth_m_s2[i];
    const Eigen::Vector3d& a2 = second.accel_in_earth_m_s2[i];
    ++sums.count;
    sums.k1k1 += k1.transpose() * k1;
    sums.k2k2 += k2.transpose() * k2;
    sums.k1a1 += k1.transpose() * a1;
    sums.k2a2 += k2.transpose() * a2;
    sums.aa += a1.squaredNorm() + a2.squaredNorm();
    for (std::size_t b = 0; b < 3; ++b) {
      const Eigen::Matrix3d& z = TurnBasis()[b];
      sums.k1zk2[b] += k1.transpose() * z * k2;
      sums.k1za2[b] += k1.transpose() * (z * a2);
      sums.a1zk2[b] += (z * k2).transpose() * a1;
      sums.a1za2[b] += a1.dot(z * a2);
    }
  }
  return sums;
}

struct Solution {
  double sse = 0.0;  // with the prior's part
  Vector6 levers_m = Vector6::Zero();
};

/// Least squares of −K₁r₁ + Z·K₂r₂ = a₁ − Z·a₂ for one δ.
Solution SolveFor(const Sums& sums, double turn_rad) {
  const std::array<double, 3> factor{std::cos(turn_rad), std::sin(turn_rad), 1.0};
  Eigen::Matrix3d k1zk2 = Eigen::Matrix3d::Zero();
  Eigen::Vector3d k1za2 = Eigen::Vector3d::Zero();
  Eigen::Vector3d a1zk2 = Eigen::Vector3d::Zero();
  double a1za2 = 0.0;
  for (std::size_t b = 0; b < 3; ++b) {
    k1zk2 += factor[b] * sums.k1zk2[b];
    k1za2 += factor[b] * sums.k1za2[b];
    a1zk2 += factor[b] * sums.a1zk2[b];
    a1za2 += factor[b] * sums.a1za2[b];
  }
  Matrix6 normal;
  normal << sums.k1k1, -k1zk2, -k1zk2.transpose(), sums.k2k2;
  const double prior = kAccelError_m_s2 / kLever_m;
  normal.diagonal().array() += static_cast<double>(sums.count) * prior * prior;
  Vector6 right;
  right << -(sums.k1a1 - k1za2), a1zk2 - sums.k2a2;
  Solution solution;
  solution.levers_m = normal.ldlt().solve(right);
  solution.sse = std::max(0.0, sums.aa - 2.0 * a1za2 - right.dot(solution.levers_m));
  return solution;
}

}  // namespace

std::optional<JointHeading> FitJointHeading(const SmoothMotion& first, const SmoothMotion& second,
                                            double rate_hz) {
  const std::size_t count = first.q_earth_sensor.size();
  if (count != second.q_earth_sensor.size() ||
      static_cast<double>(count) < kMinWindow_s * rate_hz) {
    return std::nullopt;
  }
  const Sums sums = SumUp(first, second);
  constexpr double kStep_rad = 2.0 * kPi / kSteps;
  std::array<double, kSteps> sse{};
  for (int step = 0; step < kSteps; ++step) {
    sse[static_cast<std::size_t>(step)] = SolveFor(sums, step * kStep_rad).sse;
  }
  const auto least = std::min_element(sse.begin(), sse.end());
  const double worst = *std::max_element(sse.begin(), sse.end());
  const auto at = static_cast<std::size_t>(least - sse.begin());
  const double before = sse[(at + kSteps - 1) % kSteps];
  const double after = sse[(at + 1) % kSteps];
  // The parabola through three points; its curvature is the information of the window.
  const double curvature = (before - 2.0 * *least + after) / (kStep_rad * kStep_rad);
  JointHeading heading;
  if (!(curvature > 0.0) || !(worst > 0.0)) {
    heading.sigma_rad = kPi;
    return heading;  // nothing moves
  }
  const double offset = 0.5 * (before - after) / (before - 2.0 * *least + after);
  heading.turn_rad = math::WrappedAngle_rad((static_cast<double>(at) + offset) * kStep_rad);
  const Solution solution = SolveFor(sums, heading.turn_rad);
  heading.p_sensor1_joint_m = solution.levers_m.head<3>();
  heading.p_sensor2_joint_m = solution.levers_m.tail<3>();
  heading.misfit = std::sqrt(solution.sse / worst);
  const double together = std::max(1.0, kCorrelation_s * rate_hz);
  const double var_m2_s4 =
      solution.sse / static_cast<double>(3 * count) + kAccelError_m_s2 * kAccelError_m_s2;
  heading.sigma_rad = std::min(kPi, std::sqrt(2.0 * var_m2_s4 * together / curvature));
  return heading;
}

}  // namespace limbcast::body
