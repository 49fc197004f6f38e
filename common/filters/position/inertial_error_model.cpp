#include "common/filters/position/inertial_error_model.hpp"

#include "common/math/rotation.hpp"

namespace limbcast::filters {
namespace {

constexpr Eigen::Index kVectors = 3;

// Columns of a calibration matrix by its nine elements (by columns): −∂/∂M(i,j) = R(:,i) x(j).
Eigen::Matrix<double, 3, 9> MatrixColumns(const Eigen::Matrix3d& R_ES, const Eigen::Vector3d& x) {
  Eigen::Matrix<double, 3, 9> columns;
  for (Eigen::Index j = 0; j < kVectors; ++j) {
    columns.middleCols<3>(kVectors * j) = R_ES * x[j];
  }
  return columns;
}

}  // namespace

void AddInertialTransition(const InertialBlock& block, const InertialStates& s, double sign,
                           Eigen::Ref<Eigen::MatrixXd, 0, Eigen::OuterStride<>> top) {
  const double D = block.dt_s;
  const Eigen::Matrix3d R_ES = block.sum_R / D;
  const Eigen::Matrix3d F_a = math::Skew(block.sum_force_in_earth / D);
  const auto rows = [&](int row, int column) { return top.block<3, 3>(row, column); };

  rows(s.p, s.p).setIdentity();
  rows(s.v, s.v).setIdentity();
  rows(s.theta, s.theta).setIdentity();
  rows(s.p, s.v) = D * Eigen::Matrix3d::Identity();
  rows(s.p, s.theta) = -sign * 0.5 * D * D * F_a;
  rows(s.v, s.theta) = -sign * D * F_a;
  rows(s.p, s.accel_bias) = -sign * 0.5 * D * D * R_ES;
  rows(s.v, s.accel_bias) = -sign * D * R_ES;
  const Eigen::Matrix3d F_a_R = sign * F_a * R_ES;
  rows(s.p, s.gyro_bias) = D * D * D / 6.0 * F_a_R;
  rows(s.v, s.gyro_bias) = 0.5 * D * D * F_a_R;
  rows(s.theta, s.gyro_bias) = -D * R_ES;
  if (s.gravity >= 0) {
    rows(s.p, s.gravity) = 0.5 * D * D * Eigen::Matrix3d::Identity();
    rows(s.v, s.gravity) = D * Eigen::Matrix3d::Identity();
  }
  if (s.accel_matrix >= 0) {
    const Eigen::Matrix<double, 3, 9> columns = MatrixColumns(R_ES, block.sum_accel_raw / D);
    top.block<3, 9>(s.p, s.accel_matrix) = -sign * 0.5 * D * D * columns;
    top.block<3, 9>(s.v, s.accel_matrix) = -sign * D * columns;
  }
  if (s.gyro_matrix >= 0) {
    const Eigen::Matrix<double, 3, 9> columns = MatrixColumns(R_ES, block.sum_gyro_raw / D);
    top.block<3, 9>(s.p, s.gyro_matrix) = sign * D * D * D / 6.0 * (F_a * columns);
    top.block<3, 9>(s.v, s.gyro_matrix) = sign * 0.5 * D * D * (F_a * columns);
    top.block<3, 9>(s.theta, s.gyro_matrix) = -D * columns;
  }
  if (s.gyro_delay >= 0) {
    top.block<3, 1>(s.theta, s.gyro_delay) = block.sum_gyro_change_in_earth;
    top.block<3, 1>(s.p, s.gyro_delay) =
        -sign * D * D / 6.0 * (F_a * block.sum_gyro_change_in_earth);
    top.block<3, 1>(s.v, s.gyro_delay) = -sign * 0.5 * D * (F_a * block.sum_gyro_change_in_earth);
  }
}

InertialProcessNoise ProcessNoiseOf(const InertialBlock& block, const InertialNoise& noise,
                                    const Eigen::Vector3d& accel_in_earth_m_s2, double inflation) {
  const double D = block.dt_s;
  const auto squared = [](double x) { return x * x; };
  const double rate_rad = block.sum_gyro_raw.norm();  // |w| D
  InertialProcessNoise q;
  q.var_v = inflation * (squared(noise.sigma_accel_m_s2_rthz) * D +
                         squared(noise.k_accel * D) * accel_in_earth_m_s2.squaredNorm() +
                         squared(noise.k_accel_bend) * block.sum_accel_bend2);
  q.cov_pv = 0.5 * D * q.var_v;
  q.var_p = D * D / 3.0 * q.var_v;
  q.var_theta =
      inflation * (squared(noise.sigma_gyro_rad_s_rthz) * D + squared(noise.k_rate * rate_rad) +
                   squared(noise.k_rate_bend) * block.sum_gyro_bend2);
  q.var_accel_bias = squared(noise.walk_accel_bias_m_s3_rthz) * D;
  q.var_gyro_bias = squared(noise.walk_gyro_bias_rad_s2_rthz) * D;
  return q;
}

void AddProcessNoise(const InertialProcessNoise& noise, const InertialStates& s,
                     Eigen::Ref<Eigen::MatrixXd, 0, Eigen::OuterStride<>> P) {
  for (Eigen::Index axis = 0; axis < kVectors; ++axis) {
    P(s.p + axis, s.p + axis) += noise.var_p;
    P(s.p + axis, s.v + axis) += noise.cov_pv;
    P(s.v + axis, s.p + axis) += noise.cov_pv;
    P(s.v + axis, s.v + axis) += noise.var_v;
    P(s.theta + axis, s.theta + axis) += noise.var_theta;
    P(s.accel_bias + axis, s.accel_bias + axis) += noise.var_accel_bias;
    P(s.gyro_bias + axis, s.gyro_bias + axis) += noise.var_gyro_bias;
  }
}

}  // namespace limbcast::filters
