#pragma once

#include <memory>
#include <string>

#include "common/base/result.hpp"
#include "common/config/config_file.hpp"
#include "services/gateway/driver.hpp"

namespace limbcast::gateway {

struct AllDriverConfigs;  // knows the drivers, which this header must not

/// The sections of all drivers, also of those that are not used: one file serves several runs.
/// Without a value: every driver's defaults. Cheap to copy.
struct DriverConfigs {
  std::shared_ptr<const AllDriverConfigs> all;
};

/// Reads [replay] and [simulator]; refusals are remembered in `file`.
[[nodiscard]] DriverConfigs ReadDriverConfigs(const config::ConfigFile& file);

/// Makes the driver of a name ("simulator", "replay"). kInvalidArgument: no such driver, or what
/// the driver's section says; else what the driver's Make refuses with.
[[nodiscard]] Result<std::unique_ptr<Driver>> MakeDriver(const std::string& name,
                                                         const DriverConfigs& configs);

}  // namespace limbcast::gateway
