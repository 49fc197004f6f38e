#pragma once

#include <Eigen/Geometry>
#include <span>

#include "common/filters/position/coil_hemisphere.hpp"
#include "common/filters/position/coil_observation.hpp"
#include "common/filters/position/coil_pose_solver.hpp"

namespace limbcast::filters {

/// What is known before the pulses are looked at.
struct CoilMotionPrior {
  Eigen::Matrix3d R_sensor_emitter = Eigen::Matrix3d::Identity();  ///< Ψ by inertial sensors
  double sigma_rad = 0.1;                                          ///< of it, one axis
  double sigma_v_m_s = 0.3;  ///< of what the velocity in dp lacks, one axis
};

/// Pose and velocity at the reference time.
struct CoilMotion {
  bool accepted = false;
  Eigen::Vector3d p_emitter_sensor_m = Eigen::Vector3d::Zero();
  Eigen::Matrix3d R_sensor_emitter = Eigen::Matrix3d::Identity();
  /// What the velocity used in dp lacked, emitter axes at the reference time.
  Eigen::Vector3d dv_emitter_m_s = Eigen::Vector3d::Zero();
  /// Of [δp, left rotation of Ψ in sensor axes, δv].
  Eigen::Matrix<double, 9, 9> cov = Eigen::Matrix<double, 9, 9>::Zero();
  double cost = 0.0;
};

/// Least squares for a sensor in motion whose orientation is about known, as it is after a loss of
/// track: nine unknowns [p, θ, δv] from the pulses, Ψ ~ prior and δv ~ N(0, σ_v²). The model of
/// SolveCoilPose with dp + δv t in place of dp. Without the velocity an unknown 0.3 m/s would be
/// 6 cm between two pulses and turn the answer by tens of degrees.
///
/// Accepted below `config.accept_cost`, within `max_range_m` and `max_sigma_m`.
[[nodiscard]] CoilMotion SolveCoilMotion(const CoilPoseConfig& config,
                                         const sensing::CoilSource& source,
                                         std::span<const CoilObservation> observations,
                                         const HemisphereRule& hemisphere,
                                         const CoilMotionPrior& prior);

}  // namespace limbcast::filters
