#include "services/gateway/drivers/simulator/simulator_driver.hpp"

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

}  // namespace

Result<std::unique_ptr<SimulatorDriver>> SimulatorDriver::Make(const SimulatorConfig& config) {
  if (const Status ok = Validate(config); !ok) {
    return ok.error();
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
    for (sensing::SensorInfo& info : person.sensors()) {
      description_.sensors.push_back(std::move(info));
    }
  }
}

Result<DriverStep> SimulatorDriver::Next(Batch& batch) {
  batch.Clear();
  // Counted from the tick, so that times do not creep.
  const double t_s = static_cast<double>(tick_) / config_.rate_hz;
  if (config_.duration_s > 0.0 && t_s >= config_.duration_s) {
    return DriverStep::kEnd;
  }
  batch.tick_at = Time{DurationFromSeconds(t_s)};
  for (SimulatedPerson& person : persons_) {
    person.Next(batch.tick_at, t_s, batch);
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
  return Ok();
}

}  // namespace limbcast::gateway
