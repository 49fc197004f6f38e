#include "common/filters/complementary_kalman_model.hpp"

#include "common/math/rotation.hpp"

namespace limbcast::filters {

using Eigen::Matrix3d;

Matrix69 ComplementaryMeasurementMatrix(const Eigen::Vector3d& Z_S, const Eigen::Vector3d& H_S,
                                        const Eigen::Vector3d& d_S) {
  Matrix69 C = Matrix69::Zero();
  C.block<3, 3>(0, 0) = -math::Skew(Z_S);
  C.block<3, 3>(3, 0) = -math::Skew(H_S + d_S);
  C.block<3, 3>(3, 6) = -Matrix3d::Identity();
  return C;
}

Matrix9 ComplementaryTransition(const Eigen::Vector3d& w_S_rad_s, double dt_s, double c_d) {
  const Matrix3d Phi = math::ExpSO3(w_S_rad_s * dt_s).toRotationMatrix().transpose();
  Matrix9 F = Matrix9::Zero();
  F.block<3, 3>(0, 0) = Phi;
  F.block<3, 3>(0, 3) = -dt_s * Matrix3d::Identity();
  F.block<3, 3>(3, 3) = Matrix3d::Identity();
  F.block<3, 3>(6, 6) = c_d * Phi;
  return F;
}

Matrix9 PropagateFull(const Matrix9& P, const Eigen::Vector3d& w_S_rad_s, double dt_s, double c_d) {
  const Matrix3d Phi = math::ExpSO3(w_S_rad_s * dt_s).toRotationMatrix().transpose();
  const Matrix3d P_tb = Phi * P.block<3, 3>(0, 3) - dt_s * P.block<3, 3>(3, 3);
  const Matrix3d P_tt =
      (Phi * P.block<3, 3>(0, 0) - dt_s * P.block<3, 3>(3, 0)) * Phi.transpose() - dt_s * P_tb;
  const Matrix3d P_td =
      c_d * (Phi * P.block<3, 3>(0, 6) - dt_s * P.block<3, 3>(3, 6)) * Phi.transpose();
  const Matrix3d P_bd = c_d * P.block<3, 3>(3, 6) * Phi.transpose();
  const Matrix3d P_dd = (c_d * c_d) * Phi * P.block<3, 3>(6, 6) * Phi.transpose();
  Matrix9 out;
  out << P_tt, P_tb, P_td, P_tb.transpose(), P.block<3, 3>(3, 3), P_bd, P_td.transpose(),
      P_bd.transpose(), P_dd;
  return out;
}

Matrix9 PropagateBlocks(const Matrix9& P, double dt_s, double c_d) {
  const Matrix3d Q_b = P.block<3, 3>(3, 3);
  Matrix9 out = Matrix9::Zero();
  out.block<3, 3>(0, 0) = P.block<3, 3>(0, 0) + dt_s * dt_s * Q_b;
  out.block<3, 3>(0, 3) = -dt_s * Q_b;
  out.block<3, 3>(3, 0) = -dt_s * Q_b;
  out.block<3, 3>(3, 3) = Q_b;
  out.block<3, 3>(6, 6) = c_d * c_d * P.block<3, 3>(6, 6);
  return out;
}

}  // namespace limbcast::filters
