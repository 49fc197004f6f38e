#pragma once

#include "common/filters/position/coil_inertial_states.hpp"
#include "common/sensing/coil_field.hpp"
#include "common/sensing/coil_frame.hpp"

namespace limbcast::filters {

/// A drive that says nothing of the field: what flowed is not within 5 % of what was stated, or no
/// current was stated.
[[nodiscard]] bool IsCurrentWrong(const sensing::CoilDrive& drive);

/// What one magnetometer sample should read, and how that depends on the error state.
struct CoilPrediction {
  Eigen::Vector3d field_tesla = Eigen::Vector3d::Zero();  ///< y, sensor axes
  Eigen::Matrix<double, 3, CoilInertialIndex::kAll> H =
      Eigen::Matrix<double, 3, CoilInertialIndex::kAll>::Zero();
  double coil_tesla = 0.0;  ///< |b|
};

/// The measurement of every sample (design/position.md section 10):
///
///   y = R_sᵀ (m_e + G p + b) ,  b = i R_m B_c(R_mᵀ p) ,  J = i R_m J_c R_mᵀ
///   H: p: R_sᵀ (J + G) ;  θ_s: R_sᵀ [m_e + G p + b]× ;  θ_m: R_sᵀ (−[b]× + J [p]×) ;  m_e: R_sᵀ ;
///   elements of G: R_sᵀ ∂(G p)
///
/// With tones b is the sum over the coils of what flows in each at the instant of the sample;
/// nothing is demodulated.
[[nodiscard]] CoilPrediction PredictCoilSample(const sensing::CoilSource& source,
                                               const sensing::CoilDrive& drive,
                                               const CoilInertialState& state);

/// The magnetometer of the source's own unit while none of its coils is on:
///
///   y = R_mᵀ m_e + o ,  H: θ_m: R_mᵀ [m_e]× ;  m_e: R_mᵀ ;  o: I
///
/// @param mag_tesla  as measured, emitter axes.
void PredictEmitterSample(const CoilInertialState& state, const Eigen::Vector3d& mag_tesla,
                          MeasurementRecord<CoilInertialIndex::kAll, 3>& record);

/// The gauge: turning everything together cannot be observed. Residual and H of
///
///   0 = R_m f_m + g :  ν = −g − R_m f ,  θ_m: −[R_m f]× ,  b_am: −R_m
///
/// @param accel_m_s2  f_m as measured, emitter axes.
void GravityGauge(const CoilInertialState& state, const Eigen::Vector3d& accel_m_s2,
                  MeasurementRecord<CoilInertialIndex::kAll, 3>& record);

/// The same of the background field: ν = m_start − m_e, H: m_e: I.
void BackgroundGauge(const CoilInertialState& state, const Eigen::Vector3d& start_earth_tesla,
                     MeasurementRecord<CoilInertialIndex::kAll, 3>& record);

using CoilPoseRecord = MeasurementRecord<CoilInertialIndex::kAll, 6>;

/// A pose that three pulses gave by themselves, as a measurement (loose coupling): position in
/// emitter axes and left rotation of Ψ, in sensor axes,
///
///   p_M = R_mᵀ p ,  Ψ = R_sᵀ R_m :  ν = [p_M,burst − p_M ; Log(Ψ_burst Ψᵀ)]
///   H: p: [R_mᵀ; 0] ;  θ_s: [0; −R_sᵀ] ;  θ_m: [R_mᵀ [p]×; R_sᵀ]
void PoseOfBurst(const CoilInertialState& state, const Eigen::Vector3d& p_emitter_sensor_m,
                 const Eigen::Matrix3d& R_sensor_emitter, CoilPoseRecord& record);

}  // namespace limbcast::filters
