#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "common/sensing/ellipsoid_fit.hpp"
#include "common/sensing/gyro_fit.hpp"
#include "common/sensing/marg_sample.hpp"
#include "common/sensing/rest_poses.hpp"
#include "common/sensing/sensor_calibration.hpp"

namespace limbcast::sensing {

enum class CalibrationMethod : std::uint8_t {
  kFits,    ///< ellipsoids, alignment of the triads, gyro by carried directions
  kPapers,  ///< six positions, min/max, null at rest (null_and_scale.hpp)
};

/// What CalibrateSensor is told beside the samples.
struct CalibrationSettings {
  CalibrationMethod method = CalibrationMethod::kFits;
  /// Papers only: size of turns about one axis each, for the gyro's scale; 0 = none. Range: [0,
  /// 63].
  double known_rotation_rad = 0.0;
  /// Local gravity. Range: [9.7, 9.9].
  double gravity_m_s2 = 9.80665;
  /// Local field, for the magnetometer's overall scale; 0 = not known, kept. Range: [0, 1e-4].
  double field_tesla = 0.0;
  /// Six poses were the case on a level surface: turn all corrected axes into the case's.
  bool level_positions = false;
  RestConfig rest = RestConfig();
  EllipsoidConfig accel{.max_residual = 0.01};  ///< norm comes from gravity
  EllipsoidConfig mag{.min_coverage = 0.8};     ///< norm comes from the field
  GyroFitConfig gyro = GyroFitConfig();
  /// Refused when the magnetometer's axes against the accelerometer's are less certain.
  double max_alignment_sigma_rad = 0.005;
};

/// What became of one triad.
struct ChannelReport {
  std::optional<TriadFit> fit;
  std::string refusal;  ///< why there is no fit, or what is lacking in it; "" = nothing
  std::vector<Eigen::Vector3d> readings;  ///< raw readings that went in (accel, mag), for a plot
};

struct SensorReport {
  SensorCalibration calibration;  ///< what was fitted; serial and calibrated_at left to the caller
  ChannelReport gyro;
  ChannelReport accel;
  ChannelReport mag;
  std::size_t poses = 0;          ///< times at rest
  double rest_s = 0.0;            ///< their length in all
  std::optional<double> dip_rad;  ///< of the field, when the magnetometer was aligned
};

/// Calibrates one sensor from its samples (one sensor, in order of time, raw): some twenty
/// different poses of a second or two at rest with turns between them, the turns about all axes.
/// Does what the data support and says for each triad why not when they do not:
///   accel  ellipsoid through the poses; else through slow free rotation (method
///   "ellipsoid-moving") mag    ellipsoid through all readings, then turned into the
///   accelerometer's axes over the poses gyro   null from rest; M from gravity carried from pose to
///   pose, else from the field
[[nodiscard]] SensorReport CalibrateSensor(std::span<const MargSample> samples,
                                           const CalibrationSettings& settings);

}  // namespace limbcast::sensing
