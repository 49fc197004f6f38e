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
  static constexpr int kBackground = 24;  ///< earth's and other steady field at the sensor, E
  static constexpr int kMixing = 12;
  static constexpr int kSensorAccelMatrix = 27;  ///< M_a
  static constexpr int kSensorGyroMatrix = 36;   ///< M_g
  static constexpr int kSensorGyroDelay = 45;    ///< t_g, one element
  static constexpr int kAll = 46;
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
  Eigen::Vector3d background_earth_tesla = Eigen::Vector3d::Zero();

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

/// Gives the three errors from `first` a variance of their own: no covariance with any other.
void SetVariance(CoilCovariance& P, int first, const Eigen::Vector3d& sigma);
void SetVariance(CoilCovariance& P, int first, double sigma);
/// The same of the nine errors of a matrix.
void SetMatrixVariance(CoilCovariance& P, int first, double sigma);

}  // namespace limbcast::filters
