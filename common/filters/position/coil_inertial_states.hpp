#pragma once

#include <Eigen/Geometry>

#include "common/filters/position/backward_pass.hpp"
#include "common/filters/position/inertial_error_model.hpp"
#include "common/filters/position/inertial_mechanisation.hpp"

namespace limbcast::filters {

/// Error state of the magnetic + inertial filter (design/position.md section 10): true minus
/// estimate, attitudes in the earth frame, left. First index of each block of three (matrices: of
/// nine, by columns); the blocks that mix with others come first. What is not to be estimated has a
/// standard deviation of zero, and stays as it is.
struct CoilInertialIndex {
  static constexpr int kP = 0;  ///< sensor minus emitter, earth frame
  static constexpr int kV = 3;  ///< its rate
  static constexpr int kSensorTheta = 6;
  static constexpr int kEmitterTheta = 9;
  static constexpr int kSensorAccelBias = 12;
  static constexpr int kSensorGyroBias = 15;
  static constexpr int kEmitterAccelBias = 18;
  static constexpr int kEmitterGyroBias = 21;
  static constexpr int kBackground = 24;  ///< earth's and other steady field at the source, E
  static constexpr int kMixing = 12;
  static constexpr int kSensorAccelMatrix = 27;  ///< M_a
  static constexpr int kSensorGyroMatrix = 36;   ///< M_g
  static constexpr int kSensorGyroDelay = 45;    ///< t_g, one element
  static constexpr int kGradient = 46;           ///< G of the background: xx, yy, xy, xz, yz
  static constexpr int kEmitterMagOffset = 51;   ///< of the source's magnetometer, its axes
  static constexpr int kAll = 54;
};

using CoilVector = Eigen::Matrix<double, CoilInertialIndex::kAll, 1>;
using CoilCovariance = Eigen::Matrix<double, CoilInertialIndex::kAll, CoilInertialIndex::kAll>;
using CoilTransition = BlockTransition<CoilInertialIndex::kAll, CoilInertialIndex::kMixing>;
using CoilRecord = BackwardRecord<CoilInertialIndex::kAll, CoilInertialIndex::kMixing, 3>;

/// Estimate of the magnetic + inertial filter.
struct CoilInertialState {
  Eigen::Vector3d p_earth_m = Eigen::Vector3d::Zero();    ///< sensor minus emitter
  Eigen::Vector3d v_earth_m_s = Eigen::Vector3d::Zero();  ///< its rate
  Eigen::Quaterniond q_earth_sensor = Eigen::Quaterniond::Identity();
  Eigen::Quaterniond q_earth_emitter = Eigen::Quaterniond::Identity();
  InertialErrors sensor;
  InertialErrors emitter;
  Eigen::Vector3d background_earth_tesla = Eigen::Vector3d::Zero();  ///< at the source
  /// Of the background, symmetric and without trace as any field without currents is.
  Eigen::Matrix3d gradient_earth_tesla_m = Eigen::Matrix3d::Zero();
  Eigen::Vector3d emitter_mag_offset_tesla = Eigen::Vector3d::Zero();

  /// m + G p: the background at the sensor.
  [[nodiscard]] Eigen::Vector3d background_at_sensor_earth_tesla() const {
    return background_earth_tesla + gradient_earth_tesla_m * p_earth_m;
  }
  [[nodiscard]] Eigen::Vector3d p_emitter_sensor_m() const {
    return q_earth_emitter.conjugate() * p_earth_m;
  }
  /// Ψ: emitter vectors to sensor vectors.
  [[nodiscard]] Eigen::Quaterniond q_sensor_emitter() const {
    return q_earth_sensor.conjugate() * q_earth_emitter;
  }
  [[nodiscard]] bool IsFinite() const;
};

/// X ⊞ d: the state corrected by an error vector.
[[nodiscard]] CoilInertialState Plus(const CoilInertialState& state, const CoilVector& error);

/// X ⊟ Y: the error vector that takes Y to X.
[[nodiscard]] CoilVector Minus(const CoilInertialState& x, const CoilInertialState& y);

/// A gradient from its five elements (CoilInertialIndex::kGradient).
[[nodiscard]] Eigen::Matrix3d GradientOf(const Eigen::Matrix<double, 5, 1>& elements);
/// And these from it.
[[nodiscard]] Eigen::Matrix<double, 5, 1> GradientElements(const Eigen::Matrix3d& gradient);

/// Gives the three errors from `first` a variance of their own: no covariance with any other.
void SetVariance(CoilCovariance& P, int first, const Eigen::Vector3d& sigma);
void SetVariance(CoilCovariance& P, int first, double sigma);
/// The same of the nine errors of a matrix.
void SetMatrixVariance(CoilCovariance& P, int first, double sigma);

}  // namespace limbcast::filters
