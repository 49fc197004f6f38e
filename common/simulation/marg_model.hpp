#pragma once

#include <Eigen/Geometry>
#include <cstdint>

#include "common/base/result.hpp"
#include "common/sensing/marg_sample.hpp"
#include "common/simulation/magnetic_world.hpp"
#include "common/simulation/random.hpp"
#include "common/simulation/rigid_motion.hpp"

namespace limbcast::simulation {

/// Standard gravity, m/s² (the earth frame's −z).
inline constexpr double kGravity_m_s2 = 9.80665;

/// Where and how a sensor sits on its segment.
struct SensorMounting {
  Eigen::Vector3d p_segment_sensor_m = Eigen::Vector3d::Zero();
  Eigen::Quaterniond q_segment_sensor = Eigen::Quaterniond::Identity();
};

/// What a perfect sensor reads at one instant, and where it is.
struct IdealMarg {
  Eigen::Quaterniond q_earth_sensor = Eigen::Quaterniond::Identity();
  Eigen::Vector3d p_earth_sensor_m = Eigen::Vector3d::Zero();
  Eigen::Vector3d gyro_rad_s = Eigen::Vector3d::Zero();
  Eigen::Vector3d accel_m_s2 = Eigen::Vector3d::Zero();
  Eigen::Vector3d mag_tesla = Eigen::Vector3d::Zero();
};

///   gyro = R_SE·ω,  accel = R_SE·(a + g·z),  mag = R_SE·B(p)
/// with a at the sensor's place (rigid_motion.hpp) and z up: specific force, +9.81 upwards at rest.
///
/// Titterton, Weston, "Strapdown Inertial Navigation Technology", 2nd ed., Eq. (3.15).
[[nodiscard]] IdealMarg MakeIdealMarg(const RigidMotion& segment, const SensorMounting& mounting,
                                      const MagneticWorld& world);

/// One three-axis sensor's errors. A part's size is drawn even on [−limit, limit] for each axis and
/// sensor; all zero is a perfect sensor.
struct TriadErrors {
  double noise_rthz = 0.0;        ///< white noise density, unit/√Hz, one-sided
  double noise = 0.0;             ///< white noise of one reading at any rate, unit
  double bias = 0.0;              ///< limit of the bias at start, unit
  double bias_walk_rts = 0.0;     ///< bias random walk, unit/√s
  double bias_per_celsius = 0.0;  ///< limit, unit/°C from the temperature at start
  double scale = 0.0;             ///< limit, fraction
  double misalignment = 0.0;      ///< limit of each off-diagonal element (rad for small angles)
  double range = 0.0;             ///< readings are clipped to ±range; 0 = no limit
  double resolution = 0.0;        ///< readings are multiples of it; 0 = not rounded
};

/// Errors of a whole sensor. Units: rad/s, m/s², tesla. For the magnetometer, bias is the hard-iron
/// and scale/misalignment the soft-iron residue that calibration left.
struct MargErrors {
  TriadErrors gyro;
  TriadErrors accel;
  TriadErrors mag;
  double start_celsius = 25.0;
  double warm_up_celsius = 0.0;  ///< rise after switching on, approached exponentially
  double warm_up_time_s = 300.0;
};

enum class NoisePreset : std::uint8_t {
  kIdeal,    ///< perfect, but for the ranges
  kDefault,  ///< a good body-worn IMU after calibration
  kPoor,     ///< a cheap one, hardly calibrated
};
[[nodiscard]] MargErrors MakeMargErrors(NoisePreset preset);

/// The first error size that is negative or not finite.
[[nodiscard]] Status Validate(const MargErrors& errors);

/// One sensor with its own errors, drawn from `random` at construction:
///   reading = round(clip((I + K)·ideal + b(t) + n)),  b walks and follows the temperature
///
/// IEEE Std 952-1997, Annex B (white noise, bias, random walk). Thread-compatible.
class MargModel {
 public:
  /// `rate_hz` > 0 sets the noise of one reading: σ = density·√(rate/2).
  MargModel(const MargErrors& errors, double rate_hz, const Random& random);

  /// Fills readings, temperature and the saturation flags of `sample`, one tick (1/rate_hz) after
  /// the last call.
  void Read(const IdealMarg& ideal, sensing::MargSample& sample);

  /// The gyro bias of the last reading, for tests.
  [[nodiscard]] const Eigen::Vector3d& gyro_bias_rad_s() const { return gyro_.bias; }

 private:
  struct Triad {
    Eigen::Matrix3d gain = Eigen::Matrix3d::Identity();
    Eigen::Vector3d start_bias = Eigen::Vector3d::Zero();
    Eigen::Vector3d walk = Eigen::Vector3d::Zero();
    Eigen::Vector3d per_celsius = Eigen::Vector3d::Zero();
    Eigen::Vector3d bias = Eigen::Vector3d::Zero();  // of the last reading
    double sigma = 0.0;
    double walk_sigma = 0.0;
    double range = 0.0;
    double resolution = 0.0;
  };
  [[nodiscard]] Triad MakeTriad(const TriadErrors& errors);
  [[nodiscard]] Eigen::Vector3f ReadTriad(Triad& triad, const Eigen::Vector3d& ideal,
                                          double warmer_celsius, bool& saturated);

  Random random_;
  double dt_s_;
  double elapsed_s_ = 0.0;
  MargErrors errors_;
  Triad gyro_;
  Triad accel_;
  Triad mag_;
};

}  // namespace limbcast::simulation
