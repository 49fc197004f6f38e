#include "common/body/horizontal_axis.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <numbers>

namespace limbcast::body {
namespace {

constexpr double kDegree_rad = std::numbers::pi / 180.0;
constexpr double kAxisFloor_rad = 5.0 * kDegree_rad;
/// Equal scatter both ways says nothing: the line is then anywhere within 90°.
constexpr double kAxisRatio_rad = 60.0 * kDegree_rad;
constexpr double kSymmetryRatio_rad = 4.0 * kDegree_rad;
constexpr double kNothing_rad = std::numbers::pi / 2.0;

Eigen::Matrix2d Covariance(const std::vector<Eigen::Vector2d>& values) {
  Eigen::Vector2d mean = Eigen::Vector2d::Zero();
  for (const Eigen::Vector2d& value : values) {
    mean += value / static_cast<double>(values.size());
  }
  Eigen::Matrix2d cov = Eigen::Matrix2d::Zero();
  for (const Eigen::Vector2d& value : values) {
    cov += (value - mean) * (value - mean).transpose() / static_cast<double>(values.size());
  }
  return cov;
}

double DirectionOf(const Eigen::Vector2d& v) {
  const double direction_rad = std::atan2(v.y(), v.x());
  return std::remainder(direction_rad, std::numbers::pi);
}

/// ½(v(t) + sign·v(t + half)) of the horizontal parts.
std::vector<Eigen::Vector2d> Part(const std::vector<Eigen::Vector3d>& vectors,
                                  std::size_t half_stride, double sign) {
  std::vector<Eigen::Vector2d> part;
  for (std::size_t i = 0; i + half_stride < vectors.size(); ++i) {
    part.emplace_back(0.5 * (vectors[i] + sign * vectors[i + half_stride]).head<2>());
  }
  return part;
}

}  // namespace

HorizontalAxis PrincipalAxis(const std::vector<Eigen::Vector3d>& vectors) {
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d> eigen(Covariance(Part(vectors, 0, 1.0)));
  const double major = eigen.eigenvalues()[1];
  HorizontalAxis axis{.direction_rad = DirectionOf(eigen.eigenvectors().col(1)),
                      .sigma_rad = kNothing_rad};
  if (major > 0.0) {
    const double ratio = std::max(0.0, eigen.eigenvalues()[0]) / major;
    axis.sigma_rad = std::min(kNothing_rad, kAxisFloor_rad + kAxisRatio_rad * ratio);
  }
  return axis;
}

HorizontalAxis SymmetricAxis(const std::vector<Eigen::Vector3d>& vectors, std::size_t half_stride) {
  if (vectors.size() <= 2 * half_stride) {
    return {.direction_rad = 0.0, .sigma_rad = kNothing_rad};
  }
  const Eigen::Matrix2d even = Covariance(Part(vectors, half_stride, 1.0));
  const Eigen::Matrix2d odd = Covariance(Part(vectors, half_stride, -1.0));
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d> eigen(even - odd);
  HorizontalAxis axis{.direction_rad = DirectionOf(eigen.eigenvectors().col(1)),
                      .sigma_rad = kNothing_rad};
  const double all = even.trace() + odd.trace();
  const double contrast = eigen.eigenvalues()[1] - eigen.eigenvalues()[0];
  if (all > 0.0 && contrast > 0.0) {
    axis.sigma_rad = std::min(
        kNothing_rad, kAxisFloor_rad + kSymmetryRatio_rad * (all / contrast) * (all / contrast));
  }
  return axis;
}

double PendulumForwardness(const std::vector<Eigen::Vector3d>& accel_m_s2, double direction_rad,
                           std::size_t half_stride, double rate_hz) {
  if (half_stride == 0 || accel_m_s2.size() <= 2 * half_stride) {
    return 0.0;
  }
  const Eigen::Vector2d forward(std::cos(direction_rad), std::sin(direction_rad));
  std::vector<double> along;
  std::vector<double> up;
  for (std::size_t i = 0; i + half_stride < accel_m_s2.size(); ++i) {
    const Eigen::Vector3d even = 0.5 * (accel_m_s2[i] + accel_m_s2[i + half_stride]);
    along.push_back(forward.dot(even.head<2>()));
    up.push_back(even.z());
  }
  // Velocity about its running mean over a step: what is left has no drift to integrate.
  std::vector<double> velocity(along.size(), 0.0);
  for (std::size_t i = 1; i < along.size(); ++i) {
    velocity[i] = velocity[i - 1] + 0.5 * (along[i] + along[i - 1]) / rate_hz;
  }
  double vu = 0.0;
  double vv = 0.0;
  double uu = 0.0;
  const std::size_t half_step = half_stride / 2;
  const auto step = static_cast<double>(2 * half_step + 1);
  for (std::size_t i = half_step; i + half_step + 1 < velocity.size(); ++i) {
    double mean_v = 0.0;
    double mean_u = 0.0;
    for (std::size_t k = i - half_step; k <= i + half_step; ++k) {
      mean_v += velocity[k] / step;
      mean_u += up[k] / step;
    }
    const double v = velocity[i] - mean_v;
    const double u = up[i] - mean_u;
    vu += v * u;
    vv += v * v;
    uu += u * u;
  }
  return vv > 0.0 && uu > 0.0 ? vu / std::sqrt(vv * uu) : 0.0;
}

}  // namespace limbcast::body
