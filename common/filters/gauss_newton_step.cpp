// Notation: E earth, S sensor; q_ES turns S into E. h, b computed and h₀, b₀ measured vectors in S.
#include "common/filters/gauss_newton_step.hpp"

namespace limbcast::filters {
namespace {

constexpr double kSingularBelow = 1e-6;
constexpr double kLambda = 1e-3;

Eigen::Quaterniond Pure(const Eigen::Vector3d& v) { return {0.0, v.x(), v.y(), v.z()}; }

// ∂(q*⊗m⊗q)/∂q, three rows. The derivative of q* along i is −i, so each column is −e⊗m⊗q + q*⊗m⊗e.
Eigen::Matrix<double, 3, 4> JacobianOfOne(const Eigen::Quaterniond& q, const Eigen::Vector3d& m) {
  const Eigen::Quaterniond mq = Pure(m) * q;
  const Eigen::Quaterniond qm = q.conjugate() * Pure(m);
  Eigen::Matrix<double, 3, 4> X;
  X.col(0) = mq.vec() + qm.vec();
  for (int axis = 0; axis < 3; ++axis) {
    const Eigen::Quaterniond e = Pure(Eigen::Vector3d::Unit(axis));
    X.col(1 + axis) = (qm * e).vec() - (e * mq).vec();
  }
  return X;
}

}  // namespace

Vector6 ComputedMeasurement(const Eigen::Quaterniond& q_ES, const Eigen::Vector3d& m_E,
                            const Eigen::Vector3d& n_E) {
  const Eigen::Quaterniond q_SE = q_ES.conjugate();
  Vector6 y;
  y << (q_SE * Pure(m_E) * q_ES).vec(), (q_SE * Pure(n_E) * q_ES).vec();
  return y;
}

Matrix64 JacobianOfDegreeTwo(const Eigen::Quaterniond& q_ES, const Eigen::Vector3d& m_E,
                             const Eigen::Vector3d& n_E) {
  Matrix64 X;
  X.topRows<3>() = JacobianOfOne(q_ES, m_E);
  X.bottomRows<3>() = JacobianOfOne(q_ES, n_E);
  return X;
}

Eigen::Vector4d FullStep(const Eigen::Quaterniond& q_ES, const Eigen::Vector3d& m_E,
                         const Eigen::Vector3d& n_E, const Eigen::Vector3d& m0_S,
                         const Eigen::Vector3d& n0_S, double rho) {
  Matrix64 X = JacobianOfDegreeTwo(q_ES, m_E, n_E);
  const Vector6 y = ComputedMeasurement(q_ES, m_E, n_E);
  Vector6 epsilon;
  epsilon << m0_S - y.head<3>(), rho * (n0_S - y.tail<3>());
  X.bottomRows<3>() *= rho;
  Eigen::Matrix4d XtX = X.transpose() * X;
  const Eigen::Vector4d Xte = X.transpose() * epsilon;
  // Per unit reference vector XᵀX has trace 12 at unit q: 1e-3 of that scale is a small λ.
  if (XtX.determinant() < kSingularBelow) {
    XtX.diagonal().array() += kLambda;
  }
  return XtX.ldlt().solve(Xte);
}

Eigen::Vector3d SolveSymmetric3(const Eigen::Matrix3d& A, const Eigen::Vector3d& c) {
  const double a = A(0, 0);
  const double b = A(0, 1);
  const double d = A(0, 2);
  const double e = A(1, 1);
  const double f = A(1, 2);
  const double g = A(2, 2);
  const double c00 = e * g - f * f;
  const double c01 = d * f - b * g;
  const double c02 = b * f - d * e;
  const double c11 = a * g - d * d;
  const double c12 = b * d - a * f;
  const double c22 = a * e - b * b;
  const double inverse_det = 1.0 / (a * c00 + b * c01 + d * c02);
  return inverse_det * Eigen::Vector3d(c00 * c.x() + c01 * c.y() + c02 * c.z(),
                                       c01 * c.x() + c11 * c.y() + c12 * c.z(),
                                       c02 * c.x() + c12 * c.y() + c22 * c.z());
}

Eigen::Vector3d ReducedStep(const Eigen::Vector3d& h_S, const Eigen::Vector3d& b_S,
                            const Eigen::Vector3d& h0_S, const Eigen::Vector3d& b0_S, double rho) {
  const double rho2 = rho * rho;
  // det A = (1+ρ²)·ρ²·|h × b|² for unit vectors.
  const double det = (1.0 + rho2) * rho2 * h_S.cross(b_S).squaredNorm();
  const double diagonal = 1.0 + rho2 + (det < kSingularBelow ? kLambda : 0.0);
  Eigen::Matrix3d A = -h_S * h_S.transpose() - (rho2 * b_S) * b_S.transpose();
  A.diagonal().array() += diagonal;
  const Eigen::Vector3d c = h0_S.cross(h_S) + rho2 * b0_S.cross(b_S);
  return 0.5 * SolveSymmetric3(A, c);
}

}  // namespace limbcast::filters
