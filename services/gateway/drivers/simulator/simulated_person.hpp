#pragma once

#include <cstdint>
#include <optional>
#include <span>
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

  /// The coils that this person wears, `t_s` after the begin; nothing when there are none.
  [[nodiscard]] std::optional<ActiveCoil> CoilAt(double t_s) const;

  /// Appends the samples, markers, coil drive and truth of the next tick; `coils` are those of
  /// everybody.
  void Next(Time measured_at, double t_s, Batch& batch, std::span<const ActiveCoil> coils = {});

  /// From `t_s` on, which is `at` on the host's clock, the coils pulse in this slot; without one
  /// they do not. Fails, and they do not, when the pulses do not fit into it.
  [[nodiscard]] Status FollowSlot(const std::optional<sensing::CoilGrant>& grant, double t_s,
                                  Time at);

  /// As the driver describes it; nothing without coils.
  [[nodiscard]] std::optional<CoilSourceInfo> coil_source() const;

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
  void AddCameras(const SimulatorConfig& config, std::uint64_t seed);
  [[nodiscard]] const Sensor* Find(body::Segment segment) const;

  simulation::PersonMotion motion_;
  simulation::MagneticWorld world_;
  bool magnetometer_;
  roster::RosterEntry roster_entry_;
  std::vector<Sensor> sensors_;
  SimulatedCoilsConfig coils_;
  simulation::CoilPulseConfig pulses_;
  bool may_pulse_ = true;
  std::uint32_t index_;
  std::optional<SimulatedCameras> cameras_;
  std::uint64_t tick_ = 0;
};

}  // namespace limbcast::gateway
