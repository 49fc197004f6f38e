#pragma once

#include "common/service/service_command_line.hpp"
#include "tools/limbcast/sub_command.hpp"

namespace limbcast::tool {

/// `limbcast smooth RECORDING`: positions of a recording from its marker and its inertial unit,
/// smoothed offline, as CSV.
[[nodiscard]] SubCommand AddSmoothCommand(service::ServiceCommandLine& line);

}  // namespace limbcast::tool
