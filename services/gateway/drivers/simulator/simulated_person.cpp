#include "services/gateway/drivers/simulator/simulated_person.hpp"

#include <cmath>
#include <string>
#include <utility>

#include "common/math/rotation.hpp"

namespace limbcast::gateway {
namespace {

using simulation::Random;

constexpr double kIronAround_s = 75.0;  // one round of the default schedule

std::uint64_t SeedOf(const SimulatorConfig& config, std::uint32_t index) {
  return Random(config.seed, "person " + std::to_string(index)).Next();
}

// People stand in a square, row by row, each turned a little from the last.
simulation::FloorPose StartOf(const SimulatorConfig& config, std::uint32_t index) {
  const auto side = static_cast<std::uint32_t>(std::ceil(std::sqrt(config.persons)));
  constexpr double kTurnEach_rad = 0.7;
  const std::uint32_t row = index / side;
  return {config.spacing_m * (index % side), config.spacing_m * row,
          config.facing_rad + kTurnEach_rad * index};
}

sensing::SensorInfo InfoOf(const SimulatorConfig& config, const simulation::MargErrors& errors,
                           const std::string& serial, const std::string& label) {
  sensing::SensorInfo info;
  info.sensor_uid = MakeSensorUid("simulator", serial);
  info.driver = "simulator";
  info.serial = serial;
  info.label = label;
  info.rate_hz = config.rate_hz;
  info.gyro_range_rad_s = static_cast<float>(errors.gyro.range);
  info.accel_range_m_s2 = static_cast<float>(errors.accel.range);
  info.gyro_noise_rad_s_rthz = static_cast<float>(errors.gyro.noise_rthz);
  info.accel_noise_m_s2_rthz = static_cast<float>(errors.accel.noise_rthz);
  if (config.magnetometer) {
    info.mag_range_tesla = static_cast<float>(errors.mag.range);
    info.mag_noise_tesla_rthz =
        static_cast<float>(errors.mag.noise / std::sqrt(0.5 * config.rate_hz));
  }
  return info;
}

}  // namespace

Result<SimulatedPerson> SimulatedPerson::Make(const SimulatorConfig& config, std::uint32_t index) {
  const auto shape = simulation::MakePersonShape(config.height_m);
  if (!shape) {
    return shape.error();
  }
  simulation::PersonMotionConfig motion_config;
  motion_config.schedule = config.motion == SimulatedMotion::kStanding
                               ? simulation::MakeStandingSchedule()
                               : simulation::MakeDefaultSchedule(config.n_pose_s);
  motion_config.start = StartOf(config, index);
  auto motion = simulation::PersonMotion::Make(*shape, motion_config);
  if (!motion) {
    return motion.error();
  }
  return SimulatedPerson(config, index, std::move(*motion));
}

SimulatedPerson::SimulatedPerson(const SimulatorConfig& config, std::uint32_t index,
                                 simulation::PersonMotion motion)
    : motion_(std::move(motion)), magnetometer_(config.magnetometer) {
  if (config.iron) {
    world_.iron =
        simulation::MakeIronZones(motion_, config.n_pose_s + kIronAround_s, SeedOf(config, index));
  }
  roster_entry_.body_id = BodyId{index + 1};
  roster_entry_.revision = 1;
  roster_entry_.person = "simulated person " + std::to_string(index + 1);
  for (const body::Segment segment : simulation::SegmentsOf(config.sensors)) {
    AddSensor(config, segment);
  }
}

void SimulatedPerson::AddSensor(const SimulatorConfig& config, body::Segment segment) {
  const std::uint32_t body = roster_entry_.body_id.value;
  const std::uint64_t seed = SeedOf(config, body - 1);
  const simulation::MargErrors errors = simulation::MakeMargErrors(config.noise);
  const std::string name(body::ToString(segment));
  const std::string serial = config.serial_prefix + "-" + std::to_string(body) + "-" + name;
  const sensing::SensorInfo info = InfoOf(config, errors, serial, name);
  sensors_.push_back(
      {.segment = segment,
       .info = info,
       .mounting = simulation::MakeMounting(segment, motion_.shape(), config.mounting, seed),
       .model = simulation::MargModel(errors, config.rate_hz, Random(seed, "sensor " + name)),
       .faults =
           FaultInjector(config.faults, body, segment, info, Random(seed, "faults " + name))});
  roster_entry_.sensors.push_back({.sensor_uid = info.sensor_uid, .segment = segment});
}

std::vector<sensing::SensorInfo> SimulatedPerson::sensors() const {
  std::vector<sensing::SensorInfo> infos;
  infos.reserve(sensors_.size());
  for (const Sensor& sensor : sensors_) {
    infos.push_back(sensor.info);
  }
  return infos;
}

void SimulatedPerson::Next(Time measured_at, double t_s, Batch& batch) {
  const simulation::PersonPose pose = motion_.At(t_s);
  for (Sensor& sensor : sensors_) {
    const simulation::RigidMotion& segment = pose.segments[body::Index(sensor.segment)];
    const simulation::IdealMarg ideal = simulation::MakeIdealMarg(segment, sensor.mounting, world_);
    sensing::MargSample sample;
    sample.sensor_uid = sensor.info.sensor_uid;
    sample.measured_at = measured_at;
    sensor.model.Read(ideal, sample);
    if (!magnetometer_) {
      sample.mag_tesla.setZero();
      sample.flags &= ~static_cast<std::uint32_t>(sensing::kMagSaturated);
      sample.flags |= sensing::kMagMissing;
    }
    sensor.faults.Pass(tick_, sample, batch.marg);
    batch.device_lost += sensor.faults.in_gap() ? 1U : 0U;

    body::SegmentTruth truth;
    truth.body_id = roster_entry_.body_id;
    truth.segment = sensor.segment;
    truth.sensor_uid = sensor.info.sensor_uid;
    truth.measured_at = measured_at;
    truth.sensor_valid = true;
    truth.segment_valid = true;
    truth.q_earth_sensor = math::Canonical(ideal.q_earth_sensor);
    truth.q_earth_segment = math::Canonical(math::QuaternionFromMatrix(segment.R_earth_local));
    truth.p_earth_segment_m = segment.p_earth_local_m;
    batch.truth.push_back(truth);
  }
  ++tick_;
}

}  // namespace limbcast::gateway
