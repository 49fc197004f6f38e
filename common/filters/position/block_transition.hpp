#pragma once

#include <Eigen/Core>

namespace limbcast::filters {

/// Transition of an error state of N elements over one covariance block, with the sparsity that
/// inertial navigation has: only the first M elements (position, velocity, attitude, ...) are mixed
/// with others, each of the rest only decays.
///
///   F = [ top ; 0  diag(decay) ],   top is M×N
///
/// M·N numbers say what N² would, and the products below cost M·N² and not N³.
template <int N, int M>
struct BlockTransition {
  static_assert(0 < M && M <= N);
  Eigen::Matrix<double, M, N> top = Eigen::Matrix<double, M, N>::Identity();
  Eigen::Matrix<double, N - M, 1> decay = Eigen::Matrix<double, N - M, 1>::Ones();

  /// F in full, for tests and for those who need it.
  [[nodiscard]] Eigen::Matrix<double, N, N> Dense() const {
    Eigen::Matrix<double, N, N> F = Eigen::Matrix<double, N, N>::Zero();
    F.template topRows<M>() = top;
    F.template bottomRightCorner<N - M, N - M>() = decay.asDiagonal();
    return F;
  }
};

/// P ← F P Fᵀ (process noise is the caller's). P must be symmetric and is so afterwards in all
/// bits.
template <int N, int M>
void PropagateCovariance(const BlockTransition<N, M>& F, Eigen::Matrix<double, N, N>& P) {
  constexpr int kRest = N - M;
  const Eigen::Matrix<double, M, N> T = F.top * P;
  const Eigen::Matrix<double, M, M> moving = T * F.top.transpose();
  P.template topLeftCorner<M, M>() = 0.5 * (moving + moving.transpose());
  P.template topRightCorner<M, kRest>() = T.template rightCols<kRest>() * F.decay.asDiagonal();
  P.template bottomLeftCorner<kRest, M>() = P.template topRightCorner<M, kRest>().transpose();
  if ((F.decay.array() != 1.0).any()) {
    P.template bottomRightCorner<kRest, kRest>().array() *= (F.decay * F.decay.transpose()).array();
  }
}

/// λ ← Fᵀ λ.
template <int N, int M>
void PropagateBack(const BlockTransition<N, M>& F, Eigen::Matrix<double, N, 1>& lambda) {
  const Eigen::Matrix<double, M, 1> moving = lambda.template head<M>();
  lambda.template head<M>().setZero();
  lambda.template tail<N - M>().array() *= F.decay.array();
  lambda.noalias() += F.top.transpose() * moving;
}

/// Λ ← Fᵀ Λ F. Λ must be symmetric and is so afterwards.
template <int N, int M>
void PropagateBack(const BlockTransition<N, M>& F, Eigen::Matrix<double, N, N>& Lambda) {
  constexpr int kRest = N - M;
  // Y = Λ F, of which only the first M rows and the lower right corner are needed.
  Eigen::Matrix<double, M, N> Y = Lambda.template topLeftCorner<M, M>() * F.top;
  Y.template rightCols<kRest>() +=
      Lambda.template topRightCorner<M, kRest>() * F.decay.asDiagonal();
  const Eigen::Matrix<double, kRest, N> Z =
      F.decay.asDiagonal() * (Lambda.template bottomLeftCorner<kRest, M>() * F.top);
  Eigen::Matrix<double, kRest, kRest> corner = Lambda.template bottomRightCorner<kRest, kRest>();
  corner.array() *= (F.decay * F.decay.transpose()).array();
  Lambda.noalias() = F.top.transpose() * Y;
  Lambda.template bottomRows<kRest>() += Z;
  Lambda.template bottomRightCorner<kRest, kRest>() += corner;
  Lambda = (0.5 * (Lambda + Lambda.transpose())).eval();
}

}  // namespace limbcast::filters
