#pragma once

#include <Eigen/Core>
#include <array>

namespace limbcast::sensing {

/// Magnetic constant, T m/A.
inline constexpr double kMu0_t_m_a = 1.25663706143591729539e-6;  // 4π·1e-7

/// A magnetic field at a point and how it changes from there.
struct FieldAndJacobian {
  Eigen::Vector3d field_tesla = Eigen::Vector3d::Zero();
  Eigen::Matrix3d jacobian_tesla_m = Eigen::Matrix3d::Zero();  ///< ∂B/∂p: symmetric, traceless
};

/// Field of a thin circular loop with axis z about the origin, exact everywhere but on the wire:
///
///   B_z   = C / (2 α² β) [ (b² − ρ² − z²) E(k²) + α² K(k²) ] ,       C = μ₀ N I / π
///   B_ρ   = C z / (2 α² β ρ) [ (b² + ρ² + z²) E(k²) − α² K(k²) ]
///   α² = b² + ρ² + z² − 2bρ ,  β² = b² + ρ² + z² + 2bρ ,  k² = 1 − α²/β²
///
/// Design/position.md section 6 (Simpson et al., NASA/TM-2013-217919). Computed in a form without
/// the cancellation that these have near the axis and far away, with u = 1/4 − t (1 − k²/2):
///
///   B_ρ/ρ = 8 C b² z K u / (α² β³) ,
///   B_z   = C b² K / (α² β) [ 1 − k²/2 − k⁴ t − (4ρ²/β²)(1/2 − 2t + k² t) ]
///
/// and the Jacobian from ∂/∂z of both, div B = 0 and curl B = 0.
///
/// @param radius_m      b > 0.
/// @param ampere_turns  N I, signed.
/// @param p_loop_m      the point, loop axes.
[[nodiscard]] FieldAndJacobian LoopField(double radius_m, double ampere_turns,
                                         const Eigen::Vector3d& p_loop_m);

/// A source of three orthogonal coils; coil c has axis c of the emitter frame M. Defaults: the
/// thesis' source (Roetenberg 2006, section 5.2.1; 0.713 A m² at 1.5 A), concentric.
struct CoilSource {
  double radius_m = 0.055;  ///< mean radius of the winding. Range: [0.005, 1]
  double turns = 50.0;      ///< Range: [1, 10000]
  /// Calibrated factors of the moments: winding cross-section, turns miscounted. Range: [0.5, 2]
  Eigen::Vector3d moment_factor = Eigen::Vector3d::Ones();
  /// Column c: centre of coil c in the emitter frame. Zero for concentric coils, whose fields are
  /// the same at p and −p; coils apart (on a belt, a network) say on which side the sensor is.
  Eigen::Matrix3d centre_m = Eigen::Matrix3d::Zero();

  [[nodiscard]] bool concentric() const { return centre_m.isZero(0.0); }

  /// Moment of coil `coil` for one ampere, A m² / A.
  [[nodiscard]] double MomentPerAmpere(int coil) const;
};

/// Field of one coil at `p_emitter_m`, both in the emitter frame. LoopField with the axes permuted
/// cyclically so that the coil's axis becomes z.
///
/// @param coil       0, 1, 2.
/// @param current_a  signed.
[[nodiscard]] FieldAndJacobian CoilField(const CoilSource& source, int coil, double current_a,
                                         const Eigen::Vector3d& p_emitter_m);

/// Field of all coils together.
///
/// @param currents_a  of each, signed.
[[nodiscard]] FieldAndJacobian CoilsField(const CoilSource& source,
                                          const Eigen::Vector3d& currents_a,
                                          const Eigen::Vector3d& p_emitter_m);

/// Field of all coils, one ampere each; column c is coil c.
[[nodiscard]] Eigen::Matrix3d CoilFieldsPerAmpere(const CoilSource& source,
                                                  const Eigen::Vector3d& p_emitter_m);

/// Field of a dipole, B = μ₀/(4π R³) (3 n nᵀ − I) m: for starting values only, it is off by 5 % at
/// 5.5 radii on the axis.
///
/// Griffiths, "Introduction to Electrodynamics", 4th ed., Eq. (5.89).
[[nodiscard]] Eigen::Vector3d DipoleField_tesla(const Eigen::Vector3d& moment_a_m2,
                                                const Eigen::Vector3d& p_m);

}  // namespace limbcast::sensing
