#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "common/base/result.hpp"
#include "services/gateway/driver.hpp"
#include "services/gateway/drivers/simulator/simulated_person.hpp"
#include "services/gateway/drivers/simulator/simulator_config.hpp"

namespace limbcast::gateway {

/// Simulated people as a driver: samples, truth, roster and sensor descriptions, the same bits for
/// the same configuration. Nothing downstream can tell it from devices.
class SimulatorDriver final : public Driver {
 public:
  [[nodiscard]] static Result<std::unique_ptr<SimulatorDriver>> Make(const SimulatorConfig& config);

  [[nodiscard]] const DriverDescription& Describe() const override { return description_; }
  [[nodiscard]] Result<DriverStep> Next(Batch& batch) override;
  [[nodiscard]] Status FollowSlots(const CoilSchedule& schedule) override;
  /// kUnsupported for a simulation without an end.
  [[nodiscard]] Status Rewind() override;

  [[nodiscard]] const std::vector<SimulatedPerson>& persons() const { return persons_; }

 private:
  SimulatorDriver(const SimulatorConfig& config, std::vector<SimulatedPerson> persons);

  SimulatorConfig config_;
  std::vector<SimulatedPerson> persons_;
  std::optional<CoilSchedule> schedule_;  // none: as configured
  DriverDescription description_;
  std::vector<ActiveCoil> coils_;  // that are on in this tick
  std::uint64_t tick_ = 0;
};

}  // namespace limbcast::gateway
