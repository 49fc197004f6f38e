#include "common/sensing/triad_alignment.hpp"

#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <Eigen/SVD>
#include <algorithm>
#include <cmath>
#include <string>

#include "common/math/rotation.hpp"
#include "common/sensing/axis_words.hpp"

namespace limbcast::sensing {

Result<AxisAlignment> AlignMagToAccel(std::span<const GravityAndField> poses,
                                      double max_sigma_rad) {
  constexpr std::size_t kFewest = 8;
  if (poses.size() < kFewest) {
    return Error{ErrorCode::kInvalidArgument,
                 "poses at rest with a magnetometer reading must be at least 8, are " +
                     std::to_string(poses.size())};
  }
  AxisAlignment found;
  Eigen::Matrix4d normal = Eigen::Matrix4d::Zero();
  double up_part = 0.0;  // of the unit field: −sin(dip)
  for (const GravityAndField& pose : poses) {
    up_part += pose.accel_m_s2.normalized().dot(pose.mag_tesla.normalized()) /
               static_cast<double>(poses.size());
  }
  const double count = static_cast<double>(poses.size());
  double sum = 0.0;
  constexpr int kSteps = 10;
  for (int step = 0; step <= kSteps; ++step) {
    normal.setZero();
    Eigen::Vector4d right = Eigen::Vector4d::Zero();
    sum = 0.0;
    for (const GravityAndField& pose : poses) {
      const Eigen::Vector3d a = pose.accel_m_s2.normalized();
      const Eigen::Vector3d m = found.R_accel_mag * pose.mag_tesla.normalized();
      const double residual = a.dot(m) - up_part;
      Eigen::Vector4d row;  // R ← Exp(δ)R: aᵀ(δ × m) = δᵀ(m × a)
      row << m.cross(a), -1.0;
      normal += row * row.transpose();
      right -= residual * row;
      sum += residual * residual;
    }
    if (step == 0) {
      found.residual_before = std::sqrt(sum / count);
    }
    if (step < kSteps) {
      const Eigen::Vector4d delta = normal.ldlt().solve(right);
      found.R_accel_mag = math::ExpSO3(delta.head<3>()).toRotationMatrix() * found.R_accel_mag;
      up_part += delta(3);
    }
  }
  found.residual_after = std::sqrt(sum / count);
  found.dip_rad = -std::asin(std::clamp(up_part, -1.0, 1.0));
  const Eigen::Matrix4d cov = sum / (count - 4.0) * normal.inverse();
  found.sigma_rad = std::sqrt(cov.diagonal().head<3>().maxCoeff());
  if (!(found.sigma_rad <= max_sigma_rad)) {
    return Error{ErrorCode::kInvalidArgument,
                 "the magnetometer's axes would be uncertain by " +
                     NumberText(found.sigma_rad * 57.29578, 2) +
                     " deg: hold more different poses still, also turned about the vertical"};
  }
  return found;
}

Result<Eigen::Matrix3d> AlignToCase(std::span<const Eigen::Vector3d> accel_m_s2) {
  constexpr double kNearCos = 0.9659;  // 15°
  Eigen::Matrix3d product = Eigen::Matrix3d::Zero();
  std::string missing;
  for (Eigen::Index axis = 0; axis < 3; ++axis) {
    for (const double sign : {1.0, -1.0}) {
      const Eigen::Vector3d face = sign * Eigen::Vector3d::Unit(axis);
      Eigen::Vector3d mean = Eigen::Vector3d::Zero();
      for (const Eigen::Vector3d& reading : accel_m_s2) {
        if (reading.normalized().dot(face) > kNearCos) {
          mean += reading.normalized();
        }
      }
      if (mean.isZero()) {
        missing += (missing.empty() ? "" : ", ") + DirectionWords(face);
      } else {
        product += face * mean.normalized().transpose();
      }
    }
  }
  if (!missing.empty()) {
    return Error{ErrorCode::kInvalidArgument,
                 "positions missing: lay the case on a level surface with " + missing + " up"};
  }
  const Eigen::JacobiSVD<Eigen::Matrix3d> svd(product, Eigen::ComputeFullU | Eigen::ComputeFullV);
  return Eigen::Matrix3d(svd.matrixU() * svd.matrixV().transpose());
}

}  // namespace limbcast::sensing
