#include "common/simulation/coil_stream.hpp"

#include <cmath>
#include <utility>

#include "common/math/rotation.hpp"

namespace limbcast::simulation {

// Notation: E earth, S sensor, M emitter.

Eigen::Vector3d SourceField_tesla(const sensing::CoilSource& source, const CoilCurrent& current,
                                  const RigidMotion& emitter, const Eigen::Vector3d& p_earth_m) {
  if (current.coil < 0 || current.current_a == 0.0) {
    return Eigen::Vector3d::Zero();
  }
  return SourceField_tesla(source, current.current_a * Eigen::Vector3d::Unit(current.coil), emitter,
                           p_earth_m);
}

Eigen::Vector3d SourceField_tesla(const sensing::CoilSource& source,
                                  const Eigen::Vector3d& currents_a, const RigidMotion& emitter,
                                  const Eigen::Vector3d& p_earth_m) {
  const Eigen::Vector3d p_M =
      emitter.R_earth_local.transpose() * (p_earth_m - emitter.p_earth_local_m);
  return emitter.R_earth_local * sensing::CoilsField(source, currents_a, p_M).field_tesla;
}

MargErrors CoilSensorErrors(double mag_noise_tesla) {
  MargErrors errors;
  errors.gyro = {.noise_rthz = 8.7e-4,
                 .bias = 5e-3,
                 .bias_walk_rts = 3e-5,
                 .scale = 2e-3,
                 .misalignment = 2e-3,
                 .range = 21.0,
                 .resolution = 6.4e-4};
  errors.accel = {.noise_rthz = 2e-3,
                  .bias = 0.03,
                  .bias_walk_rts = 2e-4,
                  .scale = 2e-3,
                  .misalignment = 2e-3,
                  .range = 100.0,
                  .resolution = 3e-3};
  errors.mag = {.noise = mag_noise_tesla,
                .scale = 1e-3,
                .misalignment = 1e-3,
                .range = 150e-6,
                .resolution = 5e-9};
  return errors;
}

CoilStream::CoilStream(CoilStreamConfig config, std::uint64_t seed)
    : config_(std::move(config)),
      sensor_model_(config_.errors, config_.rate_hz, Random(seed, "sensor")),
      emitter_model_(config_.errors, config_.rate_hz, Random(seed, "emitter")),
      p_begin_m_(config_.sensor(0.0).p_earth_local_m) {}

void CoilStream::Pulse(int coil, double current_a) {
  asked_ = {.coil = coil,
            .begin_s = static_cast<double>(tick_) / config_.rate_hz,
            .current_a = current_a};
}

Eigen::Vector3d CoilStream::AddedField_tesla(const Eigen::Vector3d& p_m) const {
  const double L = config_.gradient_reach_m;
  return config_.gradient_tesla_m * (L * ((p_m - p_begin_m_) / L).array().sin().matrix());
}

sensing::CoilDrive CoilStream::Drive(double t_s, const RigidMotion& emitter,
                                     const Eigen::Vector3d& p_m,
                                     Eigen::Vector3d& field_E_tesla) const {
  const double at_source_s = t_s - config_.pulses.clock_error_s;
  if (config_.tones) {
    sensing::CoilDrive drive;
    if (at_source_s < config_.pulses.begin_s) {
      return drive;
    }
    field_E_tesla += SourceField_tesla(
        config_.source, sensing::ToneCurrents_a(*config_.tones, at_source_s), emitter, p_m);
    drive.coil = sensing::kAllCoils;
    drive.current_a = config_.tones->amplitude_a;
    drive.tones_a = sensing::ToneCurrents_a(*config_.tones, t_s);
    return drive;
  }
  const auto newest_at = [&](double at_s) {
    return config_.on_demand ? asked_ : PulseAt(config_.pulses, at_s);
  };
  field_E_tesla += SourceField_tesla(
      config_.source, TrueCurrent(config_.pulses, newest_at(at_source_s), at_source_s), emitter,
      p_m);
  return StatedDrive(config_.pulses, newest_at(t_s), t_s);
}

CoilTick CoilStream::Next() {
  const double t_s = static_cast<double>(tick_++) / config_.rate_hz;
  const RigidMotion sensor = config_.sensor(t_s);
  const RigidMotion emitter = config_.emitter(t_s);
  IdealMarg ideal = MakeIdealMarg(sensor, {}, config_.world);
  const Eigen::Vector3d p_m = sensor.p_earth_local_m;
  Eigen::Vector3d added_E = AddedField_tesla(p_m);
  Eigen::Vector3d added_at_emitter_E = AddedField_tesla(emitter.p_earth_local_m);
  CoilTick tick;
  tick.frame.drive = Drive(t_s, emitter, p_m, added_E);
  Drive(t_s, emitter, emitter.p_earth_local_m, added_at_emitter_E);
  for (const ForeignSource& other : config_.foreign) {
    const CoilCurrent current = TrueCurrent(other.pulses, t_s);
    const RigidMotion motion = other.motion(t_s);
    added_E += SourceField_tesla(config_.source, current, motion, p_m);
    added_at_emitter_E +=
        SourceField_tesla(config_.source, current, motion, emitter.p_earth_local_m);
    const sensing::CoilDrive drive = StatedDrive(other.pulses, t_s);
    if (other.masked && (drive.coil >= 0 || !drive.settled)) {
      tick.frame.drive.settled = false;
    }
  }
  ideal.mag_tesla += sensor.R_earth_local.transpose() * added_E;
  IdealMarg emitter_ideal = MakeIdealMarg(emitter, {}, config_.world);
  emitter_ideal.mag_tesla += emitter.R_earth_local.transpose() * added_at_emitter_E;

  sensing::MargSample read;
  sensor_model_.Read(ideal, read);
  sensing::MargSample emitter_read;
  emitter_model_.Read(emitter_ideal, emitter_read);
  constexpr std::uint32_t kInertialSaturated = sensing::kGyroSaturated | sensing::kAccelSaturated;
  tick.frame.measured_at = TimeFromNanoseconds(0) + DurationFromSeconds(t_s);
  tick.frame.gyro_rad_s = read.gyro_rad_s.cast<double>();
  tick.frame.accel_m_s2 = read.accel_m_s2.cast<double>();
  tick.frame.mag_tesla = read.mag_tesla.cast<double>();
  tick.frame.mag_valid = !read.Has(sensing::kMagSaturated);
  tick.frame.emitter_inertial = config_.emitter_inertial;
  tick.frame.emitter_gyro_rad_s = emitter_read.gyro_rad_s.cast<double>();
  tick.frame.emitter_accel_m_s2 = emitter_read.accel_m_s2.cast<double>();
  tick.frame.emitter_mag_tesla = emitter_read.mag_tesla.cast<double>();
  tick.frame.emitter_mag_valid = config_.emitter_inertial && config_.emitter_magnetometer &&
                                 !emitter_read.Has(sensing::kMagSaturated);
  tick.frame.inertial_saturated =
      ((read.flags | (config_.emitter_inertial ? emitter_read.flags : 0U)) & kInertialSaturated) !=
      0U;
  tick.p_emitter_sensor_m = emitter.R_earth_local.transpose() * (p_m - emitter.p_earth_local_m);
  tick.q_sensor_emitter =
      math::QuaternionFromMatrix(sensor.R_earth_local.transpose() * emitter.R_earth_local);
  return tick;
}

std::vector<CoilTick> SimulateCoil(const CoilStreamConfig& config, double duration_s,
                                   std::uint64_t seed) {
  CoilStream stream(config, seed);
  std::vector<CoilTick> ticks(static_cast<std::size_t>(duration_s * config.rate_hz));
  for (CoilTick& tick : ticks) {
    tick = stream.Next();
  }
  return ticks;
}

}  // namespace limbcast::simulation
