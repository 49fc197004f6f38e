#pragma once

#include <Eigen/Geometry>
#include <cstdint>
#include <vector>

#include "common/sensing/marg_sample.hpp"
#include "common/simulation/marg_model.hpp"

/// A person who turns one sensor by hand to calibrate it, and what the sensor's true errors are.
namespace limbcast::sensing::scene {

inline constexpr double kRate_hz = 100.0;
inline constexpr double kField_tesla = 48.6e-6;
inline constexpr double kDip_rad = 1.12;  // 64°, central Europe

/// Orientations held one after the other.
struct Handling {
  std::vector<Eigen::Quaterniond> poses;
  double rest_s = 2.0;
  double turn_s = 1.5;
};

/// Even over all rotations.
[[nodiscard]] Handling RandomPoses(std::size_t count, std::uint64_t seed);
/// What the guidance asks for: the 6 faces, 12 edges and 8 corners of a cube upwards in turn, each
/// held within 10° by hand and turned about the vertical at random. With `level_faces` the faces
/// lie on a level table.
[[nodiscard]] Handling GuidedPoses(bool level_faces, std::uint64_t seed);
/// The case on a level table, each face up once: +x −x +y −y +z −z, each also turned about the
/// vertical by `heading_rad`, and off the table by up to `tilt_rad` (drawn even in each axis).
[[nodiscard]] Handling SixFaces(double heading_rad, double tilt_rad, std::uint64_t seed);

/// Readings of `handling`: rests, and smooth turns (minimum jerk, one axis each) in between.
[[nodiscard]] std::vector<MargSample> Read(const Handling& handling,
                                           const simulation::MargErrors& errors,
                                           std::uint64_t seed);
/// Readings of one orientation and rate, for tests that build their own motion.
[[nodiscard]] simulation::IdealMarg IdealAt(const Eigen::Quaterniond& q_earth_sensor,
                                            const Eigen::Vector3d& gyro_rad_s);

/// A cheap sensor as it comes: scale 2 %, misalignment 0.02 (1.1°) for each element, biases of 20
/// mg, 1°/s and 20 µT; noise as simulation::NoisePreset::kDefault.
[[nodiscard]] simulation::MargErrors FactoryErrors();

/// reading = gain · truth + bias, of one triad.
struct TriadTruth {
  Eigen::Matrix3d gain;
  Eigen::Vector3d bias;
};
struct SensorTruth {
  TriadTruth gyro;
  TriadTruth accel;
  TriadTruth mag;
};
/// What the sensor of that seed has inside (the same draws, without noise and clipping).
[[nodiscard]] SensorTruth TruthOf(simulation::MargErrors errors, std::uint64_t seed);

/// What is left of the errors of a corrected triad whose axes are turned by R_common against the
/// true ones.
struct LeftErrors {
  double scale = 0.0;             ///< largest |length of a corrected axis − 1|
  double misalignment_rad = 0.0;  ///< largest angle of a corrected axis to where it should be
};
[[nodiscard]] LeftErrors ErrorsLeft(const Eigen::Matrix3d& matrix, const Eigen::Matrix3d& gain,
                                    const Eigen::Matrix3d& R_common);
/// The rotation nearest to matrix·gain (polar decomposition): what no reading of lengths can see.
[[nodiscard]] Eigen::Matrix3d CommonRotation(const Eigen::Matrix3d& matrix,
                                             const Eigen::Matrix3d& gain);

}  // namespace limbcast::sensing::scene
