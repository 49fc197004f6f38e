#include "common/filters/position/coil_measurement.hpp"

#include <cmath>

#include "common/math/rotation.hpp"

namespace limbcast::filters {
namespace {

using Index = CoilInertialIndex;
constexpr double kGravity_m_s2 = 9.81;  // design/position.md section 1

constexpr double kCurrentOff = 0.05;  // of what was stated

sensing::FieldAndJacobian DrivenField(const sensing::CoilSource& source,
                                      const sensing::CoilDrive& drive,
                                      const Eigen::Vector3d& p_emitter_m) {
  return drive.coil == sensing::kAllCoils
             ? sensing::CoilsField(source, drive.tones_a, p_emitter_m)
             : sensing::CoilField(source, drive.coil, drive.current_a, p_emitter_m);
}

// ∂(G p) by the five elements of G.
Eigen::Matrix<double, 3, 5> ByGradient(const Eigen::Vector3d& p) {
  Eigen::Matrix<double, 3, 5> A;
  A << p.x(), 0.0, p.y(), p.z(), 0.0,  //
      0.0, p.y(), p.x(), 0.0, p.z(),   //
      -p.z(), -p.z(), 0.0, p.x(), p.y();
  return A;
}

}  // namespace

bool IsCurrentWrong(const sensing::CoilDrive& drive) {
  if (!std::isfinite(drive.current_a) || !drive.tones_a.allFinite()) {
    return true;
  }
  return drive.coil >= 0 && std::isfinite(drive.measured_a) &&
         !(std::abs(drive.measured_a - drive.current_a) <= kCurrentOff * std::abs(drive.current_a));
}

CoilPrediction PredictCoilSample(const sensing::CoilSource& source, const sensing::CoilDrive& drive,
                                 const CoilInertialState& state) {
  CoilPrediction prediction;
  const Eigen::Matrix3d R_SE = state.q_earth_sensor.toRotationMatrix().transpose();
  Eigen::Vector3d field_E = state.background_at_sensor_earth_tesla();
  prediction.H.middleCols<3>(Index::kP) = R_SE * state.gradient_earth_tesla_m;
  prediction.H.middleCols<5>(Index::kGradient) = R_SE * ByGradient(state.p_earth_m);
  if (drive.coil >= 0) {
    const Eigen::Matrix3d R_EM = state.q_earth_emitter.toRotationMatrix();
    const sensing::FieldAndJacobian f =
        DrivenField(source, drive, R_EM.transpose() * state.p_earth_m);
    const Eigen::Vector3d b_E = R_EM * f.field_tesla;
    const Eigen::Matrix3d J = R_EM * f.jacobian_tesla_m * R_EM.transpose();
    field_E += b_E;
    prediction.coil_tesla = b_E.norm();
    prediction.H.middleCols<3>(Index::kP) += R_SE * J;
    prediction.H.middleCols<3>(Index::kEmitterTheta) =
        R_SE * (J * math::Skew(state.p_earth_m) - math::Skew(b_E));
  }
  prediction.field_tesla = R_SE * field_E;
  prediction.H.middleCols<3>(Index::kSensorTheta) = R_SE * math::Skew(field_E);
  prediction.H.middleCols<3>(Index::kBackground) = R_SE;
  return prediction;
}

void PredictEmitterSample(const CoilInertialState& state, const Eigen::Vector3d& mag_tesla,
                          MeasurementRecord<CoilInertialIndex::kAll, 3>& record) {
  const Eigen::Matrix3d R_ME = state.q_earth_emitter.toRotationMatrix().transpose();
  record.nu = mag_tesla - R_ME * state.background_earth_tesla - state.emitter_mag_offset_tesla;
  record.H.setZero();
  record.H.middleCols<3>(Index::kEmitterTheta) = R_ME * math::Skew(state.background_earth_tesla);
  record.H.middleCols<3>(Index::kBackground) = R_ME;
  record.H.middleCols<3>(Index::kEmitterMagOffset).setIdentity();
}

void GravityGauge(const CoilInertialState& state, const Eigen::Vector3d& accel_m_s2,
                  MeasurementRecord<CoilInertialIndex::kAll, 3>& record) {
  const Eigen::Matrix3d R_EM = state.q_earth_emitter.toRotationMatrix();
  const Eigen::Vector3d f_E = R_EM * (accel_m_s2 - state.emitter.accel_bias_m_s2);
  record.nu = kGravity_m_s2 * Eigen::Vector3d::UnitZ() - f_E;
  record.H.setZero();
  record.H.middleCols<3>(Index::kEmitterTheta) = -math::Skew(f_E);
  record.H.middleCols<3>(Index::kEmitterAccelBias) = -R_EM;
}

void BackgroundGauge(const CoilInertialState& state, const Eigen::Vector3d& start_earth_tesla,
                     MeasurementRecord<CoilInertialIndex::kAll, 3>& record) {
  record.nu = start_earth_tesla - state.background_earth_tesla;
  record.H.setZero();
  record.H.middleCols<3>(Index::kBackground).setIdentity();
}

void PoseOfBurst(const CoilInertialState& state, const Eigen::Vector3d& p_emitter_sensor_m,
                 const Eigen::Matrix3d& R_sensor_emitter, CoilPoseRecord& record) {
  const Eigen::Matrix3d R_ME = state.q_earth_emitter.toRotationMatrix().transpose();
  const Eigen::Matrix3d R_SE = state.q_earth_sensor.toRotationMatrix().transpose();
  record.nu.head<3>() = p_emitter_sensor_m - R_ME * state.p_earth_m;
  record.nu.tail<3>() = math::LogSO3(math::QuaternionFromMatrix(R_sensor_emitter) *
                                     state.q_sensor_emitter().conjugate());
  record.H.setZero();
  record.H.block<3, 3>(0, Index::kP) = R_ME;
  record.H.block<3, 3>(0, Index::kEmitterTheta) = R_ME * math::Skew(state.p_earth_m);
  record.H.block<3, 3>(3, Index::kSensorTheta) = -R_SE;
  record.H.block<3, 3>(3, Index::kEmitterTheta) = R_SE;
}

}  // namespace limbcast::filters
