// Notation: E earth, S sensor; q_ES turns S into E. h, b computed and h₀, b₀ measured vectors in S.
#include "common/filters/gauss_newton_step.hpp"

#include "common/filters/gauss_newton_kernel.hpp"

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
  const auto x = kernel::SolveSymmetric<double>(A(0, 0), A(0, 1), A(0, 2), A(1, 1), A(1, 2),
                                                A(2, 2), {c.x(), c.y(), c.z()});
  return {x.x, x.y, x.z};
}

Eigen::Vector3d ReducedStep(const Eigen::Vector3d& h_S, const Eigen::Vector3d& b_S,
                            const Eigen::Vector3d& h0_S, const Eigen::Vector3d& b0_S, double rho) {
  const auto plain = [](const Eigen::Vector3d& v) {
    return kernel::Vector<double>{v.x(), v.y(), v.z()};
  };
  const auto dv = kernel::ReducedStep(plain(h_S), plain(b_S), plain(h0_S), plain(b0_S), rho * rho);
  return {dv.x, dv.y, dv.z};
}

}  // namespace limbcast::filters
