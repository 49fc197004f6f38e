#pragma once

#include <Eigen/Geometry>
#include <cstdint>
#include <optional>
#include <span>

#include "common/filters/position/coil_closed_form.hpp"
#include "common/filters/position/coil_hemisphere.hpp"
#include "common/filters/position/coil_observation.hpp"
#include "common/sensing/coil_field.hpp"

namespace limbcast::filters {

/// Limits of SolveCoilPose (design/position.md section 8).
struct CoilPoseConfig {
  double accept_cost = 30.0;  ///< for 9 values and 6 unknowns; grows with more pulses
  double max_sigma_m = 0.1;   ///< of the position, √(tr C_p)
  double max_range_m = 1.2;
  double floor_sigma_m = 0.002;      ///< model error that is always there
  double floor_sigma_rad = 0.00873;  ///< 0.5°
  double var_velocity_m2_s2 = 0.0;   ///< of the velocity used in dp, one axis
  int max_iterations = 40;
};

enum class CoilPoseVerdict : std::uint8_t {
  kAccepted,
  kMissingCoil,   ///< not every coil has a pulse with a signal
  kPoorFit,       ///< no start led to an acceptable cost
  kTooFar,        ///< beyond max_range_m
  kTooUncertain,  ///< beyond max_sigma_m
  kUndecided,     ///< p or −p: the hemisphere rule does not say
};

/// Pose of a sensor from the pulses of one source, at the reference time of the observations.
struct CoilPose {
  CoilPoseVerdict verdict = CoilPoseVerdict::kMissingCoil;
  Eigen::Vector3d p_emitter_sensor_m = Eigen::Vector3d::Zero();
  Eigen::Quaterniond q_sensor_emitter = Eigen::Quaterniond::Identity();  ///< Ψ
  /// Of [δp (emitter axes), left rotation of Ψ (sensor axes)]; true minus estimate.
  Eigen::Matrix<double, 6, 6> cov = Eigen::Matrix<double, 6, 6>::Zero();
  /// The same without velocity error and floor: the Cramér–Rao bound.
  Eigen::Matrix<double, 6, 6> cov_noise = Eigen::Matrix<double, 6, 6>::Zero();
  /// J_v: what an error of the velocity used in dp (emitter axes) does to the pose.
  Eigen::Matrix<double, 6, 3> by_velocity = Eigen::Matrix<double, 6, 3>::Zero();
  double cost = 0.0;  ///< Σ |r|²/σ²
  int starts = 0;     ///< 1: the first one was good
};

/// Least squares with the exact field by Levenberg–Marquardt, Ψ ← Exp(θ) Ψ (design/position.md
/// section 8): from `predicted` when given, else from the closed form; when the cost is not
/// acceptable, from five radii in five directions with rotations by Procrustes. Of coils apart,
/// from all eight octants: the signal says on which side the sensor is, `hemisphere` what is not
/// allowed.
///
///   C = A⁻¹ + J_v P_vv J_vᵀ + floor
///
/// Allocates nothing. Useful by itself: needs no filter.
[[nodiscard]] CoilPose SolveCoilPose(const CoilPoseConfig& config,
                                     const sensing::CoilSource& source,
                                     std::span<const CoilObservation> observations,
                                     const HemisphereRule& hemisphere,
                                     const std::optional<CoilStart>& predicted = std::nullopt);

/// What the model says of an observation at a pose.
[[nodiscard]] Eigen::Vector3d PredictCoilField_tesla(const sensing::CoilSource& source,
                                                     const CoilObservation& observation,
                                                     const CoilStart& pose);

}  // namespace limbcast::filters
