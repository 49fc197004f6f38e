#include "common/filters/position/coil_closed_form.hpp"

#include <Eigen/LU>
#include <Eigen/SVD>
#include <cmath>
#include <numbers>

namespace limbcast::filters {

// Notation: S sensor, M emitter at the reference time; Psi = R_SM.

std::optional<Eigen::Matrix3d> SignalMatrix(std::span<const CoilObservation> observations) {
  Eigen::Matrix3d S = Eigen::Matrix3d::Zero();
  Eigen::Vector3d weight = Eigen::Vector3d::Zero();
  for (const CoilObservation& o : observations) {
    S.col(o.coil) += o.current_a * (o.R_pulse_reference_sensor.transpose() * o.field_tesla);
    weight[o.coil] += o.current_a * o.current_a;
  }
  if (!(weight.minCoeff() > 0.0) || !S.allFinite()) {
    return std::nullopt;
  }
  return S * weight.cwiseInverse().asDiagonal();
}

Eigen::Matrix3d ProcrustesRotation(const Eigen::Matrix3d& S, const Eigen::Matrix3d& B) {
  const Eigen::JacobiSVD<Eigen::Matrix3d> svd(S * B.transpose(),
                                              Eigen::ComputeFullU | Eigen::ComputeFullV);
  const Eigen::Matrix3d& U = svd.matrixU();
  const Eigen::Matrix3d& V = svd.matrixV();
  const double sign = (U * V.transpose()).determinant() < 0.0 ? -1.0 : 1.0;
  return U * Eigen::Vector3d(1.0, 1.0, sign).asDiagonal() * V.transpose();
}

std::optional<CoilStart> CoilClosedForm(const sensing::CoilSource& source,
                                        std::span<const CoilObservation> observations) {
  std::optional<Eigen::Matrix3d> S = SignalMatrix(observations);
  if (!S) {
    return std::nullopt;
  }
  // For one A m², and the noise of one element likewise.
  double noise2 = 0.0;
  for (int coil = 0; coil < 3; ++coil) {
    S->col(coil) /= source.MomentPerAmpere(coil);
  }
  for (const CoilObservation& o : observations) {
    const double sigma = o.sigma_tesla / (o.current_a * source.MomentPerAmpere(o.coil));
    noise2 += sigma * sigma / static_cast<double>(observations.size());
  }
  const double all = S->squaredNorm();
  if (!(all > 0.0) || !std::isfinite(all)) {
    return std::nullopt;
  }
  constexpr double kLeast = 0.1;  // of the signal, when there is little but noise
  const double k = std::sqrt(std::max(all - 9.0 * noise2, kLeast * all) / 6.0);
  const Eigen::JacobiSVD<Eigen::Matrix3d> svd(*S, Eigen::ComputeFullV);
  const Eigen::Vector3d n = svd.matrixV().col(0);
  CoilStart start;
  start.p_emitter_sensor_m = std::cbrt(sensing::kMu0_t_m_a / (4.0 * std::numbers::pi * k)) * n;
  start.R_sensor_emitter =
      ProcrustesRotation(*S, 3.0 * n * n.transpose() - Eigen::Matrix3d::Identity());
  return start;
}

}  // namespace limbcast::filters
