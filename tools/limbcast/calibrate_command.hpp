#pragma once

#include "common/service/service_command_line.hpp"
#include "tools/limbcast/sub_command.hpp"

namespace limbcast::tool {

/// `limbcast calibrate sensor`: scale, misalignment and offsets of sensors, from a recording or
/// live from a running gateway. `limbcast calibrate session`: local gravity and field, and who sees
/// it disturbed.
[[nodiscard]] SubCommand AddCalibrateCommand(service::ServiceCommandLine& line);

}  // namespace limbcast::tool
