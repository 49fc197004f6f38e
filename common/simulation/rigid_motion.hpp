#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "common/simulation/jet.hpp"

namespace limbcast::simulation {

/// How a rigid frame moves at one instant. All vectors in the earth frame; "local" are the frame's
/// own axes.
struct RigidMotion {
  Eigen::Matrix3d R_earth_local = Eigen::Matrix3d::Identity();
  Eigen::Vector3d w_earth_local_rad_s = Eigen::Vector3d::Zero();
  Eigen::Vector3d wd_earth_local_rad_s2 = Eigen::Vector3d::Zero();  ///< angular acceleration
  Eigen::Vector3d p_earth_local_m = Eigen::Vector3d::Zero();        ///< origin of the frame
  Eigen::Vector3d v_earth_local_m_s = Eigen::Vector3d::Zero();
  Eigen::Vector3d a_earth_local_m_s2 = Eigen::Vector3d::Zero();
};

/// The frame at `p_earth_m`, not turned.
[[nodiscard]] RigidMotion MovingPoint(const Jet3& p_earth_m);

/// The frame turned about its own x, y or z axis (0, 1, 2) by a moving angle:
///   R' = R·Rot(axis, θ),  ω' = ω + θ̇·n,  α' = α + θ̈·n + ω × θ̇·n,  n = R·axis
///
/// Craig, "Introduction to Robotics", 3rd ed., Eq. (6.32), (6.33), in the earth frame.
void RotateAbout(RigidMotion& frame, int axis, const Jet& angle_rad);

/// The frame with its origin moved to the point `p_local_m` that it carries:
///   p' = p + r,  v' = v + ω × r,  a' = a + α × r + ω × (ω × r),  r = R·p_local
///
/// Ibid., Eq. (6.34).
[[nodiscard]] RigidMotion AtPoint(const RigidMotion& frame, const Eigen::Vector3d& p_local_m);

/// Sets orientation, rate and angular acceleration from three moving, orthonormal axes:
///   ω× = Ṙ·Rᵀ,  α× = skew part of R̈·Rᵀ
/// (R̈Rᵀ = α× + ω×ω×, and the second term is symmetric).
void SetAxes(RigidMotion& frame, const Jet3& x, const Jet3& y, const Jet3& z);

/// The moving origin as jets.
[[nodiscard]] Jet3 Origin(const RigidMotion& frame);

}  // namespace limbcast::simulation
