#pragma once

#include <Eigen/Geometry>
#include <cstdint>
#include <functional>
#include <optional>
#include <vector>

#include "common/sensing/coil_field.hpp"
#include "common/sensing/coil_frame.hpp"
#include "common/sensing/coil_tones.hpp"
#include "common/simulation/coil_pulses.hpp"
#include "common/simulation/magnetic_world.hpp"
#include "common/simulation/marg_model.hpp"
#include "common/simulation/rigid_motion.hpp"

namespace limbcast::simulation {

using MotionFunction = std::function<RigidMotion(double t_s)>;

/// Another person's source, whose pulses this sensor feels.
struct ForeignSource {
  MotionFunction motion;
  CoilPulseConfig pulses;
  bool masked = true;  ///< its slots are known: samples in them are marked as useless
};

/// A source of coils, a sensor, and the world they are in.
struct CoilStreamConfig {
  CoilPulseConfig pulses;
  bool on_demand = false;  ///< no train: Pulse() says when and with which coil
  /// Frequency multiplex in the place of pulses, from pulses.begin_s on; currents are regulated.
  std::optional<sensing::CoilTones> tones;
  sensing::CoilSource source;
  MotionFunction sensor;         ///< the sensor's own axes and place
  MotionFunction emitter;        ///< the axes and centre of the coils
  bool emitter_inertial = true;  ///< false: a fixed source without inertial unit
  /// The source's unit has a magnetometer, too; of no use while one of its coils is on.
  bool emitter_magnetometer = true;
  double rate_hz = 120.0;
  MargErrors errors;  ///< of both inertial units, drawn for each
  MagneticWorld world;
  /// Of the field where the sensor begins, tesla/m; symmetric and traceless. Each coordinate's
  /// change levels off to ±gradient_reach_m, so that a long walk stays in the earth's field.
  Eigen::Matrix3d gradient_tesla_m = Eigen::Matrix3d::Zero();
  double gradient_reach_m = 1.0;
  std::vector<ForeignSource> foreign;
};

/// A frame and the truth of its instant.
struct CoilTick {
  sensing::CoilFrame frame;
  Eigen::Vector3d p_emitter_sensor_m = Eigen::Vector3d::Zero();
  Eigen::Quaterniond q_sensor_emitter = Eigen::Quaterniond::Identity();
};

/// MTx-like inertial units (Roetenberg 2006, section 6.3: 120 Hz, 16 bits) with this noise of one
/// magnetometer reading; range 150 µT.
[[nodiscard]] MargErrors CoilSensorErrors(double mag_noise_tesla);

/// Field of a source at a place, both in the earth frame:  R_EM Σ i_c B_c(R_MEᵀ (p − p_M)).
[[nodiscard]] Eigen::Vector3d SourceField_tesla(const sensing::CoilSource& source,
                                                const CoilCurrent& current,
                                                const RigidMotion& emitter,
                                                const Eigen::Vector3d& p_earth_m);
[[nodiscard]] Eigen::Vector3d SourceField_tesla(const sensing::CoilSource& source,
                                                const Eigen::Vector3d& currents_a,
                                                const RigidMotion& emitter,
                                                const Eigen::Vector3d& p_earth_m);

/// A recording without end, tick by tick. Readings are those of MargModel; the magnetometer feels
///   B = B_world(p) + G L sin((p − p_begin)/L) + Σ i_c(t) R_EM B_c(R_MEᵀ (p − p_M))
/// Thread-compatible; a copy goes on by itself.
class CoilStream {
 public:
  CoilStream(CoilStreamConfig config, std::uint64_t seed);

  /// The tick at k / rate_hz, k = 0, 1, ...
  [[nodiscard]] CoilTick Next();

  /// On demand: a pulse begins at the next tick. The one before is over and has settled.
  void Pulse(int coil, double current_a);

 private:
  CoilStreamConfig config_;
  // The gradient's part of the field.
  [[nodiscard]] Eigen::Vector3d AddedField_tesla(const Eigen::Vector3d& p_m) const;
  // Adds the field of the source to `field_E_tesla`; returns what it says that it does.
  sensing::CoilDrive Drive(double t_s, const RigidMotion& emitter, const Eigen::Vector3d& p_m,
                           Eigen::Vector3d& field_E_tesla) const;

  MargModel sensor_model_;
  MargModel emitter_model_;
  Eigen::Vector3d p_begin_m_;
  std::int64_t tick_ = 0;
  CoilPulse asked_;
};

/// The first `duration_s` of a CoilStream.
[[nodiscard]] std::vector<CoilTick> SimulateCoil(const CoilStreamConfig& config, double duration_s,
                                                 std::uint64_t seed);

}  // namespace limbcast::simulation
