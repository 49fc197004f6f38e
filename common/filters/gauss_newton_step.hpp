#pragma once

#include <Eigen/Geometry>

namespace limbcast::filters {

/// The mathematics of the Gauss–Newton filter of Bachmann and McGhee, apart from the tracker around
/// it. Criterion: y(q) = (q*⊗m⊗q, q*⊗n⊗q) ∈ R⁶, ε = y₀ − y(q), rows 4–6 of both times ρ, φ = εᵀε.
/// The publications take NED and m = (0, 0, 1) down; here m is any unit reference, in this project
/// up in ENU. That changes nothing: a sign and a fixed rotation of the earth frame cancel.
///
/// [B·n] Bachmann et al., VRST 2001; [M·n] McGhee et al., theory report; [P·n] US 6,820,025.

using Matrix64 = Eigen::Matrix<double, 6, 4>;
using Vector6 = Eigen::Matrix<double, 6, 1>;

/// Both reference vectors in sensor coordinates, as the estimate computes them: y(q).
[[nodiscard]] Vector6 ComputedMeasurement(const Eigen::Quaterniond& q_ES,
                                          const Eigen::Vector3d& m_E, const Eigen::Vector3d& n_E);

/// X = ∂y/∂q of [M·39–42], y taken as homogeneous of degree 2: columns
/// (m⊗q + q*⊗m), (−i⊗m⊗q + q*⊗m⊗i), likewise j and k. Regular at unit q because X q = 2y.
[[nodiscard]] Matrix64 JacobianOfDegreeTwo(const Eigen::Quaterniond& q_ES,
                                           const Eigen::Vector3d& m_E, const Eigen::Vector3d& n_E);

/// Full 4×4 step Δq = (XᵀX)⁻¹Xᵀε with weight ρ [M·39–42, 57]; the new estimate is q + αΔq,
/// normalised. With ρ = 0, λ = 1e-3 on the diagonal keeps it solvable.
///
/// @param m0_S, n0_S  measured, unit vectors.
[[nodiscard]] Eigen::Vector4d FullStep(const Eigen::Quaterniond& q_ES, const Eigen::Vector3d& m_E,
                                       const Eigen::Vector3d& n_E, const Eigen::Vector3d& m0_S,
                                       const Eigen::Vector3d& n0_S, double rho);

/// Reduced 3×3 step [M·44–51, P·29]: Δq = q⊗(0, Δv), Δv = ½ A⁻¹ c with
///   A = (1+ρ²) I − h hᵀ − ρ² b bᵀ,   c = h₀×h + ρ² (b₀×b)
/// by cofactors. When det A < 1e-6 (h ∥ b, or ρ = 0) λ = 1e-3 is added to the diagonal.
///
/// @param h_S, b_S    computed, unit vectors.
/// @param h0_S, b0_S  measured, unit vectors.
[[nodiscard]] Eigen::Vector3d ReducedStep(const Eigen::Vector3d& h_S, const Eigen::Vector3d& b_S,
                                          const Eigen::Vector3d& h0_S, const Eigen::Vector3d& b0_S,
                                          double rho);

/// Inverse of a symmetric 3×3 matrix with det ≠ 0 times a vector, by cofactors.
[[nodiscard]] Eigen::Vector3d SolveSymmetric3(const Eigen::Matrix3d& A, const Eigen::Vector3d& c);

}  // namespace limbcast::filters
