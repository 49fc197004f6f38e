#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "common/base/result.hpp"
#include "common/roster/roster.hpp"
#include "common/sensing/sensor_info.hpp"
#include "common/simulation/person_motion.hpp"
#include "services/gateway/driver.hpp"
#include "services/gateway/drivers/simulator/simulator_config.hpp"

namespace limbcast::gateway {

/// One simulated person with its sensors and the iron around it. Thread-compatible.
class SimulatedPerson {
 public:
  /// Person `index` (from 0) of a validated configuration. Fails as PersonMotion::Make.
  [[nodiscard]] static Result<SimulatedPerson> Make(const SimulatorConfig& config,
                                                    std::uint32_t index);

  /// Appends the samples and the truth of the next tick.
  void Next(Time measured_at, double t_s, Batch& batch);

  [[nodiscard]] const roster::RosterEntry& roster_entry() const { return roster_entry_; }
  [[nodiscard]] std::vector<sensing::SensorInfo> sensors() const;
  [[nodiscard]] const simulation::MagneticWorld& world() const { return world_; }
  [[nodiscard]] const simulation::PersonMotion& motion() const { return motion_; }

 private:
  struct Sensor {
    body::Segment segment;
    sensing::SensorInfo info;
    simulation::SensorMounting mounting;
    simulation::MargModel model;
    FaultInjector faults;
  };
  SimulatedPerson(const SimulatorConfig& config, std::uint32_t index,
                  simulation::PersonMotion motion);
  void AddSensor(const SimulatorConfig& config, body::Segment segment);

  simulation::PersonMotion motion_;
  simulation::MagneticWorld world_;
  bool magnetometer_;
  roster::RosterEntry roster_entry_;
  std::vector<Sensor> sensors_;
  std::uint64_t tick_ = 0;
};

}  // namespace limbcast::gateway
