#pragma once

#include <Eigen/Geometry>
#include <optional>
#include <span>

#include "common/filters/position/coil_observation.hpp"
#include "common/sensing/coil_field.hpp"

namespace limbcast::filters {

/// Position up to its sign, and orientation, of a sensor from one pulse of each coil.
struct CoilStart {
  Eigen::Vector3d p_emitter_sensor_m = Eigen::Vector3d::Zero();    ///< or its negative
  Eigen::Matrix3d R_sensor_emitter = Eigen::Matrix3d::Identity();  ///< Ψ
};

/// Matrix S, column c: field of coil c for one ampere, turned into sensor axes at the reference
/// time (mean of the pulses when a coil has several). None when a coil has no pulse.
[[nodiscard]] std::optional<Eigen::Matrix3d> SignalMatrix(
    std::span<const CoilObservation> observations);

/// Closed form for dipoles by singular values (design/position.md section 8):
///
///   S = k Ψ (3 n nᵀ − I):  n = v₁ ,  k² = (tr SᵀS − 9 σ²)/6 ,  R = (μ₀ m/(4π k))^⅓ ,
///   Ψ = U diag(1, 1, det(U Vᵀ)) Vᵀ  with  U·Vᵀ = svd(S (3 n nᵀ − I))
///
/// Never a final answer: a dipole is 14 to 28 mm off within 0.3 m. None when a coil has no pulse or
/// there is no signal.
[[nodiscard]] std::optional<CoilStart> CoilClosedForm(
    const sensing::CoilSource& source, std::span<const CoilObservation> observations);

/// The rotation Ψ that fits S ≈ Ψ B best in the least-squares sense.
[[nodiscard]] Eigen::Matrix3d ProcrustesRotation(const Eigen::Matrix3d& S,
                                                 const Eigen::Matrix3d& B);

}  // namespace limbcast::filters
