#include "common/math/rotation.hpp"

#include <algorithm>
#include <cmath>

namespace limbcast::math {
namespace {

constexpr double kSeriesBelow_rad = 1e-4;  // the first terms left out are below double precision

}  // namespace

Eigen::Matrix3d Skew(const Eigen::Vector3d& a) {
  Eigen::Matrix3d a_x;
  a_x << 0.0, -a.z(), a.y(), a.z(), 0.0, -a.x(), -a.y(), a.x(), 0.0;
  return a_x;
}

Eigen::Quaterniond ExpSO3(const Eigen::Vector3d& phi_rad) {
  const double theta2 = phi_rad.squaredNorm();
  const double theta = std::sqrt(theta2);
  double w = 1.0 - theta2 / 8.0;
  double scale = 0.5 - theta2 / 48.0;  // sin(θ/2)/θ
  if (theta >= kSeriesBelow_rad) {
    w = std::cos(0.5 * theta);
    scale = std::sin(0.5 * theta) / theta;
  }
  return {w, scale * phi_rad.x(), scale * phi_rad.y(), scale * phi_rad.z()};
}

Eigen::Vector3d LogSO3(const Eigen::Quaterniond& q) {
  const Eigen::Quaterniond p = Canonical(q);
  const double sine = p.vec().norm();  // sin(θ/2)
  if (sine < 0.5 * kSeriesBelow_rad) {
    // θ/sin(θ/2) = 2 + s²/3 + O(s⁴) with s = sin(θ/2)
    return (2.0 + sine * sine / 3.0) * p.vec();
  }
  return (2.0 * std::atan2(sine, p.w()) / sine) * p.vec();
}

Eigen::Matrix3d RightJacobianSO3(const Eigen::Vector3d& phi_rad) {
  const double theta2 = phi_rad.squaredNorm();
  const double theta = std::sqrt(theta2);

  double a = 0.5 - theta2 / 24.0;         // (1 − cos θ)/θ²
  double b = 1.0 / 6.0 - theta2 / 120.0;  // (θ − sin θ)/θ³
  if (theta > kSeriesBelow_rad) {
    a = (1.0 - std::cos(theta)) / theta2;
    b = (theta - std::sin(theta)) / (theta2 * theta);
  }

  const Eigen::Matrix3d phi_x = Skew(phi_rad);
  return Eigen::Matrix3d::Identity() - a * phi_x + b * phi_x * phi_x;
}

Eigen::Quaterniond QuaternionFromMatrix(const Eigen::Matrix3d& R) {
  // Eigen's conversion picks the largest pivot; here it gets a name and a tested promise.
  return Eigen::Quaterniond(R).normalized();
}

double AngleBetween_rad(const Eigen::Quaterniond& a, const Eigen::Quaterniond& b) {
  return LogSO3(a.conjugate() * b).norm();
}

Eigen::Quaterniond Canonical(const Eigen::Quaterniond& q) {
  return q.w() < 0.0 ? Eigen::Quaterniond(-q.w(), -q.x(), -q.y(), -q.z()) : q;
}

Eigen::Quaterniond NearestSign(const Eigen::Quaterniond& q, const Eigen::Quaterniond& reference) {
  return q.dot(reference) < 0.0 ? Eigen::Quaterniond(-q.w(), -q.x(), -q.y(), -q.z()) : q;
}

double Heading_rad(const Eigen::Quaterniond& q_earth_any) {
  const Eigen::Quaterniond q = Canonical(q_earth_any);
  return 2.0 * std::atan2(q.z(), q.w());
}

Eigen::Quaterniond Slerp(const Eigen::Quaterniond& a, const Eigen::Quaterniond& b, double t) {
  return (a * ExpSO3(t * LogSO3(a.conjugate() * b))).normalized();
}

}  // namespace limbcast::math
