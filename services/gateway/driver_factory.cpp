#include "services/gateway/driver_factory.hpp"

#include <utility>

#include "services/gateway/drivers/replay/replay_driver.hpp"
#include "services/gateway/drivers/simulator/simulator_driver.hpp"

namespace limbcast::gateway {

struct AllDriverConfigs {
  ReplayConfig replay;
  SimulatorConfig simulator;
};

namespace {

template <typename T>
Result<std::unique_ptr<Driver>> Upcast(Result<std::unique_ptr<T>> made) {
  if (!made) {
    return made.error();
  }
  return std::unique_ptr<Driver>(std::move(*made));
}

}  // namespace

DriverConfigs ReadDriverConfigs(const config::ConfigFile& file) {
  return {.all = std::make_shared<const AllDriverConfigs>(
              AllDriverConfigs{.replay = ReadReplayConfig(file.Get("replay")),
                               .simulator = ReadSimulatorConfig(file.Get("simulator"))})};
}

Result<std::unique_ptr<Driver>> MakeDriver(const std::string& name, const DriverConfigs& configs) {
  const AllDriverConfigs all = configs.all != nullptr ? *configs.all : AllDriverConfigs{};
  if (name == "simulator") {
    if (const Status valid = Validate(all.simulator); !valid) {
      return valid.error();
    }
    return Upcast(SimulatorDriver::Make(all.simulator));
  }
  if (name == "replay") {
    if (all.replay.recording.empty()) {
      return Error{ErrorCode::kInvalidArgument,
                   "replay.recording is not set (--recording PATH): a file or folder to play"};
    }
    return Upcast(ReplayDriver::Make(all.replay));
  }
  return Error{ErrorCode::kInvalidArgument,
               "gateway.driver must be simulator or replay, is " + name};
}

}  // namespace limbcast::gateway
