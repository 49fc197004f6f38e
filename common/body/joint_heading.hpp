#pragma once

#include <Eigen/Core>
#include <optional>

#include "common/body/motion_record.hpp"

namespace limbcast::body {

/// How the earth frames of two sensors beside one joint are turned against each other.
struct JointHeading {
  double turn_rad = 0.0;   ///< v_earth1 = Rz(turn)·v_earth2
  double sigma_rad = 0.0;  ///< of the turn, from the sharpness of the minimum
  double misfit = 1.0;     ///< rms at the minimum over rms at the worst turn, in [0, 1]
  Eigen::Vector3d p_sensor1_joint_m = Eigen::Vector3d::Zero();
  Eigen::Vector3d p_sensor2_joint_m = Eigen::Vector3d::Zero();
};

/// Finds the turn from what any joint keeps: its centre is one point, whose acceleration is the
/// same by both sensors,
///
///   a₁ + K₁R₁r₁ = Rz(δ)·(a₂ + K₂R₂r₂),   K = [α]× + [ω]×²,
///
/// all in the earth frame of the sensor, r from the sensor to the joint in its own axes. For each δ
/// the rest is linear in r₁, r₂; the sum of squares over the window is searched over the whole
/// circle, so that no starting value and no axis of the joint is needed, and forward is not taken
/// for backward.
///
/// Seel, Schauer, Raisch, "Joint axis and position estimation from inertial measurement data by
/// exploiting kinematic constraints", CCA 2012, Eq. (7)–(8) (the constraint); Weygers, Kok et al.,
/// "Drift-free inertial sensor-based joint kinematics for long-term arbitrary movements", IEEE
/// Sensors J. 20(14) 2020 (relative orientation from it). The search over δ is ours. A prior of
/// kLever_m on r₁, r₂ keeps directions bounded that the motion does not show.
///
/// Nothing when both are of different length or shorter than 2 s.
[[nodiscard]] std::optional<JointHeading> FitJointHeading(const SmoothMotion& first,
                                                          const SmoothMotion& second,
                                                          double rate_hz);

}  // namespace limbcast::body
