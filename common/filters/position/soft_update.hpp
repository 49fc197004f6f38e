#pragma once

#include <Eigen/Cholesky>
#include <Eigen/Core>
#include <cmath>
#include <cstdint>

namespace limbcast::filters {

/// What became of a measurement at the gate.
enum class GateOutcome : std::uint8_t {
  kFused,         ///< NIS within what chance explains
  kDownweighted,  ///< its covariance was scaled up until it fits
  kRejected,      ///< far outside; at most a few in a row
};

/// Soft gating (design/position.md section 4). A measurement is never locked out for good: a filter
/// that is wrong must hear of it.
struct SoftGateConfig {
  double downweight_above_nis = 16.0;
  double reject_above_nis = 1e4;
  int max_rejected_in_a_row = 5;
};

/// One measurement as the backward pass needs it again (see backward_pass.hpp).
template <int N, int Z>
struct MeasurementRecord {
  bool fused = false;             ///< false: nothing below was used
  Eigen::Matrix<double, Z, N> H;  ///< ∂h/∂(error state)
  Eigen::Matrix<double, N, Z> K;  ///< gain
  Eigen::Matrix<double, Z, Z> S_inverse;
  Eigen::Matrix<double, Z, 1> nu;  ///< innovation
};

/// What SoftUpdate says of a measurement.
struct UpdateReport {
  GateOutcome outcome = GateOutcome::kFused;
  double nis = 0.0;  ///< νᵀS⁻¹ν before any scaling; mean = Z when the filter is consistent
};

/// Kalman update of P with a soft gate:
///
///   S = H P Hᵀ + R,  NIS = νᵀ S⁻¹ ν,  S ← S·max(1, NIS/16),  K = P Hᵀ S⁻¹,  P ← P − K (H P)
///
/// symmetrised. The error K ν is returned through `record` for the caller to add to its state.
///
/// @param H, nu            in `record`, filled by the caller.
/// @param may_reject       false: a measurement beyond the last limit is downweighted, too.
/// @returns kRejected when S is not positive or not finite as well; P is then unchanged.
template <int N, int Z>
UpdateReport SoftUpdate(const SoftGateConfig& gate, const Eigen::Matrix<double, Z, Z>& R,
                        bool may_reject, Eigen::Matrix<double, N, N>& P,
                        MeasurementRecord<N, Z>& record) {
  UpdateReport report;
  record.fused = false;
  const Eigen::Matrix<double, Z, N> HP = record.H * P;
  Eigen::Matrix<double, Z, Z> S = HP * record.H.transpose() + R;
  S = (0.5 * (S + S.transpose())).eval();
  const Eigen::LLT<Eigen::Matrix<double, Z, Z>> factor(S);
  report.nis = record.nu.dot(factor.solve(record.nu));
  if (factor.info() != Eigen::Success || !std::isfinite(report.nis)) {
    report.outcome = GateOutcome::kRejected;
    return report;
  }
  double scale = 1.0;
  if (report.nis > gate.downweight_above_nis) {
    if (report.nis > gate.reject_above_nis && may_reject) {
      report.outcome = GateOutcome::kRejected;
      return report;
    }
    report.outcome = GateOutcome::kDownweighted;
    scale = report.nis / gate.downweight_above_nis;
  }
  record.S_inverse = factor.solve(Eigen::Matrix<double, Z, Z>::Identity()) / scale;
  record.K.noalias() = HP.transpose() * record.S_inverse;
  P.noalias() -= record.K * HP;
  P = (0.5 * (P + P.transpose())).eval();
  record.fused = true;
  return report;
}

}  // namespace limbcast::filters
