#pragma once

#include <Eigen/Core>

#include "common/filters/position/block_transition.hpp"
#include "common/filters/position/soft_update.hpp"

namespace limbcast::filters {

/// One epoch of a forward pass as the backward pass needs it: how the epoch was reached from the
/// one before, and what was measured at it.
template <int N, int M, int Z>
struct BackwardRecord {
  BlockTransition<N, M> into;  ///< from the epoch before to this one
  MeasurementRecord<N, Z> measurement;
  bool chain_begins = false;  ///< the state was set anew here: nothing goes back past this epoch
  bool stays = false;         ///< a further measurement of the same instant: `into` is not read
};

/// Backward pass of the fixed-interval and fixed-lag smoother in the form of Bryson and Frazier, as
/// modified by Bierman ("Fixed interval smoothing with discrete measurements", Int. J. Control
/// 18(1), 1973). It gives what the recursion of Rauch, Tung and Striebel gives (design/position.md
/// section 5; a test compares the two), without its inverse of P⁻ and with a cost of M·N in place
/// of N² for each step:
///
///   after the measurement of epoch t:   X^s = X⁺ ⊞ P⁺ λ ,   P^s = P⁺ − P⁺ Λ P⁺
///   over the measurement:               λ ← Hᵀ S⁻¹ ν + (I − K H)ᵀ λ ,
///                                       Λ ← Hᵀ S⁻¹ H + (I − K H)ᵀ Λ (I − K H)
///   over the transition into t:         λ ← Fᵀ λ ,  Λ ← Fᵀ Λ F
///
/// with λ = 0, Λ = 0 at the newest epoch. A downweighted measurement enters with its scaled S, and
/// a jump of process noise needs nothing at all.
///
/// This function: λ of the epoch before, after its measurement, from λ of this one.
template <int N, int M, int Z>
void StepBack(const BackwardRecord<N, M, Z>& record, Eigen::Matrix<double, N, 1>& lambda) {
  if (record.chain_begins) {
    lambda.setZero();
    return;
  }
  const auto& m = record.measurement;
  if (m.fused) {
    const Eigen::Matrix<double, Z, 1> pull = m.S_inverse * m.nu - m.K.transpose() * lambda;
    lambda.noalias() += m.H.transpose() * pull;
  }
  if (!record.stays) {
    PropagateBack(record.into, lambda);
  }
}

/// The same for the information Λ.
template <int N, int M, int Z>
void StepBack(const BackwardRecord<N, M, Z>& record, Eigen::Matrix<double, N, N>& Lambda) {
  if (record.chain_begins) {
    Lambda.setZero();
    return;
  }
  const auto& m = record.measurement;
  if (m.fused) {
    // (I − KH)ᵀ Λ (I − KH) = Λ − HᵀG − GᵀH + Hᵀ(KᵀΛK)H with G = KᵀΛ
    const Eigen::Matrix<double, Z, N> G = m.K.transpose() * Lambda;
    const Eigen::Matrix<double, Z, Z> inner = m.S_inverse + G * m.K;
    const Eigen::Matrix<double, Z, N> half = 0.5 * inner * m.H - G;
    const Eigen::Matrix<double, N, N> change = m.H.transpose() * half;
    Lambda += change + change.transpose();
  }
  if (!record.stays) {
    PropagateBack(record.into, Lambda);
  }
}

/// Covariance that later measurements leave of `rows` (C of them) of an epoch, without Λ: the rows
/// W = C P⁺ are carried forward through the closed loop, and every measurement takes its share
/// away. Costs C times a mean step; for outputs of which only a few rows are wanted.
///
///   W ← W Fᵀ ;  cov −= (W Hᵀ) S⁻¹ (W Hᵀ)ᵀ ;  W ← W (I − K H)ᵀ
template <int N, int M, int Z, int C>
void StepForward(const BackwardRecord<N, M, Z>& record, Eigen::Matrix<double, C, N>& W,
                 Eigen::Matrix<double, C, C>& cov) {
  if (!record.stays) {
    const Eigen::Matrix<double, C, M> moving = W * record.into.top.transpose();
    W.template rightCols<N - M>() = W.template rightCols<N - M>() * record.into.decay.asDiagonal();
    W.template leftCols<M>() = moving;
  }
  const auto& m = record.measurement;
  if (m.fused) {
    const Eigen::Matrix<double, C, Z> WH = W * m.H.transpose();
    cov.noalias() -= WH * m.S_inverse * WH.transpose();
    W.noalias() -= WH * m.K.transpose();
  }
}

}  // namespace limbcast::filters
