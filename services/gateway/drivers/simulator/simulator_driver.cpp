#include "services/gateway/drivers/simulator/simulator_driver.hpp"

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

namespace limbcast::gateway {
namespace {

Result<std::vector<SimulatedPerson>> MakePersons(const SimulatorConfig& config) {
  std::vector<SimulatedPerson> persons;
  persons.reserve(config.persons);
  for (std::uint32_t i = 0; i < config.persons; ++i) {
    auto person = SimulatedPerson::Make(config, i);
    if (!person) {
      return person.error();
    }
    persons.push_back(std::move(*person));
  }
  return persons;
}

// Coils and markers sit on sensors, so those must be there.
Status CheckWorn(const SimulatorConfig& config) {
  const auto worn = simulation::SegmentsOf(config.sensors);
  const auto check = [&](const char* key, body::Segment segment) {
    if (std::find(worn.begin(), worn.end(), segment) != worn.end()) {
      return Ok();
    }
    return Status(Error{ErrorCode::kInvalidArgument,
                        "simulator." + std::string(key) + ": " +
                            std::string(body::ToString(segment)) +
                            " carries no sensor in this set of simulator.sensors"});
  };
  Status worn_well = Ok();
  if (config.coils.source) {
    worn_well = check("coils.source", *config.coils.source);
    for (const body::Segment segment : config.coils.sensors) {
      worn_well = worn_well ? check("coils.sensors", segment) : worn_well;
    }
  }
  for (const body::Segment segment : config.cameras.markers) {
    worn_well = worn_well ? check("cameras.markers", segment) : worn_well;
  }
  return worn_well;
}

}  // namespace

Result<std::unique_ptr<SimulatorDriver>> SimulatorDriver::Make(const SimulatorConfig& config) {
  if (const Status ok = Validate(config); !ok) {
    return ok.error();
  }
  if (Status worn = CheckWorn(config); !worn) {
    return worn.error();
  }
  auto persons = MakePersons(config);
  if (!persons) {
    return persons.error();
  }
  return std::unique_ptr<SimulatorDriver>(new SimulatorDriver(config, std::move(*persons)));
}

SimulatorDriver::SimulatorDriver(const SimulatorConfig& config,
                                 std::vector<SimulatedPerson> persons)
    : config_(config), persons_(std::move(persons)) {
  description_.driver = "simulator";
  description_.source =
      std::to_string(config.persons) + " simulated, seed " + std::to_string(config.seed);
  description_.time = DriverTime::kRecording;
  description_.tick_rate_hz = config.rate_hz;
  description_.has_truth = true;
  for (const SimulatedPerson& person : persons_) {
    description_.bodies.push_back(person.roster_entry());
    if (auto source = person.coil_source()) {
      roster::RosterEntry& body = description_.bodies.back();
      body.coil_slot = source->slot + 1;
      body.coil_slots = config.coils.slots;
      body.coil_frame_us =
          static_cast<std::uint32_t>(std::lround(1e6 * config.coils.slots * config.coils.slot_s));
      description_.coil_sources.push_back(*std::move(source));
    }
    for (sensing::SensorInfo& info : person.sensors()) {
      description_.sensors.push_back(std::move(info));
    }
  }
}

Status SimulatorDriver::FollowSlots(const CoilSchedule& schedule) {
  const double t_s = static_cast<double>(tick_) / config_.rate_hz;
  const Time at = Time{DurationFromSeconds(t_s)} + schedule.to_host;
  const bool same_time = schedule_ && schedule_->to_host == schedule.to_host;
  Status followed = Ok();
  for (SimulatedPerson& person : persons_) {
    const BodyId body = person.roster_entry().body_id;
    const auto grant = schedule.Of(body);
    // A train of pulses that goes on is not begun anew for what others do.
    if (same_time && schedule_->Of(body) == grant) {
      continue;
    }
    if (Status fits = person.FollowSlot(grant, t_s, at); !fits) {
      followed = fits;
    }
  }
  schedule_ = schedule;
  return followed;
}

Result<DriverStep> SimulatorDriver::Next(Batch& batch) {
  batch.Clear();
  // Counted from the tick, so that times do not creep.
  const double t_s = static_cast<double>(tick_) / config_.rate_hz;
  if (config_.duration_s > 0.0 && t_s >= config_.duration_s) {
    return DriverStep::kEnd;
  }
  batch.tick_at = Time{DurationFromSeconds(t_s)};
  coils_.clear();
  for (const SimulatedPerson& person : persons_) {
    if (const auto active = person.CoilAt(t_s); active && active->current.current_a != 0.0) {
      coils_.push_back(*active);
    }
  }
  for (SimulatedPerson& person : persons_) {
    person.Next(batch.tick_at, t_s, batch, coils_);
  }
  ++tick_;
  return DriverStep::kData;
}

Status SimulatorDriver::Rewind() {
  if (config_.duration_s <= 0.0) {
    return Error{ErrorCode::kUnsupported,
                 "a simulation without duration_s has no end to go back "
                 "from"};
  }
  auto persons = MakePersons(config_);
  if (!persons) {
    return persons.error();
  }
  persons_ = std::move(*persons);
  tick_ = 0;
  if (const auto schedule = std::exchange(schedule_, std::nullopt)) {
    return FollowSlots(*schedule);
  }
  return Ok();
}

}  // namespace limbcast::gateway
