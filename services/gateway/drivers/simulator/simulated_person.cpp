#include "services/gateway/drivers/simulator/simulated_person.hpp"

#include <fmt/format.h>

#include <algorithm>
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
    : motion_(std::move(motion)),
      magnetometer_(config.magnetometer),
      coils_(config.coils),
      pulses_(PulsesOf(config.coils, index, SeedOf(config, index))),
      index_(index) {
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
  if (coils_.source && Find(*coils_.source) == nullptr) {
    coils_.source.reset();  // refused by SimulatorDriver::Make
  }
  AddCameras(config, SeedOf(config, index));
}

void SimulatedPerson::AddCameras(const SimulatorConfig& config, std::uint64_t seed) {
  std::vector<SimulatedCameras::Marker> markers;
  for (const body::Segment segment : config.cameras.markers) {
    if (const Sensor* const sensor = Find(segment)) {
      markers.push_back({.segment = segment, .mounting = sensor->mounting});
    }
  }
  if (!markers.empty()) {
    cameras_.emplace(config.cameras, std::move(markers), Random(seed, "cameras"));
  }
}

const SimulatedPerson::Sensor* SimulatedPerson::Find(body::Segment segment) const {
  const auto found = std::find_if(sensors_.begin(), sensors_.end(),
                                  [&](const Sensor& sensor) { return sensor.segment == segment; });
  return found == sensors_.end() ? nullptr : &*found;
}

Status SimulatedPerson::FollowSlot(const std::optional<sensing::CoilGrant>& grant, double t_s,
                                   Time at) {
  if (!coils_.source) {
    return Ok();
  }
  may_pulse_ = grant.has_value();
  if (!may_pulse_) {
    return Ok();
  }
  const double slot_s = ToSeconds(grant->slot_length());
  if (slot_s < LeastSlot_s(coils_)) {
    may_pulse_ = false;
    return Error{
        ErrorCode::kInvalidArgument,
        fmt::format("the coils of {} need slots of {} s, and are granted {} s: they do not "
                    "pulse",
                    roster_entry_.person, LeastSlot_s(coils_), slot_s)};
  }
  pulses_.cycle_s = 3.0 * ToSeconds(grant->frame);
  pulses_.begin_s = t_s + ToSeconds(sensing::NextSlotBegin(*grant, at) - at);
  return Ok();
}

std::optional<ActiveCoil> SimulatedPerson::CoilAt(double t_s) const {
  if (!coils_.source || !may_pulse_) {
    return std::nullopt;
  }
  const simulation::SensorMounting& mounting = Find(*coils_.source)->mounting;
  ActiveCoil active;
  active.emitter = simulation::AtPoint(motion_.At(t_s).segments[body::Index(*coils_.source)],
                                       mounting.p_segment_sensor_m);
  active.emitter.R_earth_local =
      active.emitter.R_earth_local * mounting.q_segment_sensor.toRotationMatrix();
  active.current = simulation::TrueCurrent(pulses_, t_s);
  return active;
}

std::optional<CoilSourceInfo> SimulatedPerson::coil_source() const {
  if (!coils_.source) {
    return std::nullopt;
  }
  CoilSourceInfo info;
  info.source_uid = Find(*coils_.source)->info.sensor_uid;
  info.body_id = roster_entry_.body_id;
  info.slot = index_ % coils_.slots;
  info.sigma_mag_tesla = std::max(coils_.mag_noise_tesla, 1e-9);
  info.current_a = coils_.current_a;
  for (const body::Segment segment : coils_.sensors) {
    if (const Sensor* const sensor = Find(segment)) {
      info.sensors.push_back(sensor->info.sensor_uid);
    }
  }
  return info;
}

void SimulatedPerson::AddSensor(const SimulatorConfig& config, body::Segment segment) {
  const std::uint32_t body = roster_entry_.body_id.value;
  const std::uint64_t seed = SeedOf(config, body - 1);
  simulation::MargErrors errors = simulation::MakeMargErrors(config.noise);
  if (config.coils.source) {
    errors.mag = CoilMagErrors(config.coils);
  }
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

void SimulatedPerson::Next(Time measured_at, double t_s, Batch& batch,
                           std::span<const ActiveCoil> coils) {
  const simulation::PersonPose pose = motion_.At(t_s);
  if (coils_.source) {
    batch.coil_drives.push_back(
        {.source_uid = Find(*coils_.source)->info.sensor_uid,
         .drive = may_pulse_ ? simulation::StatedDrive(pulses_, t_s) : sensing::CoilDrive{}});
  }
  if (cameras_) {
    cameras_->Next(motion_, roster_entry_.body_id, measured_at, t_s, batch.markers);
  }
  for (Sensor& sensor : sensors_) {
    const simulation::RigidMotion& segment = pose.segments[body::Index(sensor.segment)];
    simulation::IdealMarg ideal = simulation::MakeIdealMarg(segment, sensor.mounting, world_);
    for (const ActiveCoil& active : coils) {
      ideal.mag_tesla += ideal.q_earth_sensor.conjugate() *
                         FieldOf_tesla(coils_.coils, active, ideal.p_earth_sensor_m);
    }
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
    truth.p_earth_sensor_m = ideal.p_earth_sensor_m;
    batch.truth.push_back(truth);
  }
  ++tick_;
}

}  // namespace limbcast::gateway
