#pragma once

#include <Eigen/Core>

namespace limbcast::filters {

/// One pulse of one coil, as a magnetometer saw it, with what the inertial sensors say of the
/// motion since the reference time of the pose that is looked for (design/position.md section 8):
///
///   y = dR Ψ dM B_coil(dMᵀ (p_M + dp)) + n ,   n ~ N(0, σ² I)
///
/// p_M is sensor minus emitter in emitter axes at the reference time, Ψ turns emitter vectors into
/// sensor vectors then.
struct CoilObservation {
  int coil = 0;            ///< 0, 1, 2: axis of the coil
  double current_a = 0.0;  ///< signed, of the plateau
  Eigen::Vector3d field_tesla =
      Eigen::Vector3d::Zero();  ///< sensor axes at the pulse, background removed
  double sigma_tesla = 0.0;     ///< one axis, > 0
  /// dR: sensor axes at the reference time to sensor axes at the pulse.
  Eigen::Matrix3d R_pulse_reference_sensor = Eigen::Matrix3d::Identity();
  /// dM: emitter axes at the pulse to emitter axes at the reference time.
  Eigen::Matrix3d R_reference_pulse_emitter = Eigen::Matrix3d::Identity();
  /// dp: displacement of the sensor from the reference time to the pulse, emitter axes at the
  /// reference time.
  Eigen::Vector3d dp_emitter_m = Eigen::Vector3d::Zero();
  double time_from_reference_s = 0.0;  ///< what an error of the velocity in dp is multiplied with
};

}  // namespace limbcast::filters
