#pragma once

#include <Eigen/Core>

#include "common/body/forward_kinematics.hpp"
#include "common/body/segment.hpp"

namespace limbcast::body {

/// Where a sensor of an arm or a leg is, measured from a sensor of the trunk (by coils).
struct LimbPosition {
  Segment segment = Segment::kRightForeArm;                      ///< that carries the sensor
  Eigen::Vector3d p_segment_sensor_m = Eigen::Vector3d::Zero();  ///< where on it
  Segment from = Segment::kPelvis;                               ///< the trunk segment
  Eigen::Vector3d p_from_sensor_m = Eigen::Vector3d::Zero();     ///< where on that its sensor is
  /// The measurement: from that sensor to this one, earth axes.
  Eigen::Vector3d p_sensor_sensor_m = Eigen::Vector3d::Zero();
  Eigen::Matrix3d cov_m2 = Eigen::Matrix3d::Zero();
};

/// How far the rest is trusted.
struct LimbPullConfig {
  /// Of a segment's orientation beside what its filter says: alignment, skin. One axis.
  double sigma_alignment_rad = 0.035;
  /// Of the joint in which the limb begins, and of where the sensors sit. One axis.
  double sigma_trunk_m = 0.015;
  /// A measurement that is off by more than so many σ (3-D) of everything together is left out.
  double most_sigmas = 5.0;
};

/// The position of the sensor pulls its limb. With the limb's segments j from the trunk outwards,
/// each from its inboard joint by the vector L_j to the next one (the last: to the sensor), a small
/// turn θ_j of each moves the sensor by
///
///   δp = Σ θ_j × L_j ,   θ_j ~ N(0, σ_j² I) ,
///
/// and the most likely turns for the residual d = measured − kinematic are
///
///   θ_j = σ_j² L_j × S⁻¹ d ,   S = Σ σ_j² (|L_j|² I − L_j L_jᵀ) + P + σ_trunk² I
///
/// so that a certain position bends the limb to where the sensor is, shared out by the σ of the
/// orientations, and an uncertain one leaves it as it is. Only measured segments turn; hands and
/// feet without a sensor are to be filled again. Derived here from Bayes' rule for independent
/// orientations.
///
/// @param sigma_rad  of the segments' orientations as their filters say, one axis.
/// @param pose       placed (ForwardKinematics::Place); orientations are changed, positions are to
///                   be placed again.
/// @returns false: nothing done, the measurement is too far off, or a segment of the chain is not
///          measured.
bool PullLimb(const LimbPullConfig& config, const LimbPosition& position,
              const PerSegment<float>& sigma_rad, BodyPose& pose);

}  // namespace limbcast::body
