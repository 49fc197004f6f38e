#pragma once

#include <Eigen/Geometry>

namespace limbcast::math {

/// The matrix [a]× with [a]×·b = a × b.
[[nodiscard]] Eigen::Matrix3d Skew(const Eigen::Vector3d& a);

/// Unit quaternion of the rotation vector φ: Exp(φ) = (cos θ/2, sin(θ/2)·φ/θ), θ = |φ|; series
/// below 1e-4 rad.
///
/// Solà, Deray, Atchuthan, "A micro Lie theory for state estimation in robotics", arXiv:1812.01537,
/// Eq. (132).
///
/// @param phi_rad  rotation vector, any finite length.
[[nodiscard]] Eigen::Quaterniond ExpSO3(const Eigen::Vector3d& phi_rad);

/// Rotation vector of a unit quaternion, the inverse of ExpSO3 with |φ| ≤ π; q and −q give the same
/// result. Ibid., Eq. (133).
[[nodiscard]] Eigen::Vector3d LogSO3(const Eigen::Quaterniond& q);

/// Right Jacobian of SO(3): Exp(φ + δ) ≈ Exp(φ)·Exp(Jr(φ)·δ) for small δ.
///
///   Jr(φ) = I − (1 − cos θ)/θ² [φ]× + (θ − sin θ)/θ³ [φ]×²,   θ = |φ|
///
/// Ibid., Eq. (143).
///
/// @param phi_rad  rotation vector, shorter than 2π.
[[nodiscard]] Eigen::Matrix3d RightJacobianSO3(const Eigen::Vector3d& phi_rad);

/// The quaternion of a rotation matrix (orthonormal, det +1), by the largest of its four pivots
/// (Shepperd 1978).
[[nodiscard]] Eigen::Quaterniond QuaternionFromMatrix(const Eigen::Matrix3d& R);

/// Angle between two orientations, in [0, π]; q and −q are the same.
[[nodiscard]] double AngleBetween_rad(const Eigen::Quaterniond& a, const Eigen::Quaterniond& b);

/// The one of q and −q with w ≥ 0, as it is published.
[[nodiscard]] Eigen::Quaterniond Canonical(const Eigen::Quaterniond& q);

/// The one of q and −q that is nearer to `reference`, for outputs without jumps of sign.
[[nodiscard]] Eigen::Quaterniond NearestSign(const Eigen::Quaterniond& q,
                                             const Eigen::Quaterniond& reference);

/// Rotation about the vertical that is left when the tilt is taken away: the twist of q about earth
/// z, in (−π, π]. For q_earth_segment it is the way the segment's x axis faces (counter-clockwise
/// from east).
[[nodiscard]] double Heading_rad(const Eigen::Quaterniond& q_earth_any);

/// Interpolation along the shorter arc; t outside [0, 1] extrapolates with the same constant rate.
[[nodiscard]] Eigen::Quaterniond Slerp(const Eigen::Quaterniond& a, const Eigen::Quaterniond& b,
                                       double t);

}  // namespace limbcast::math
