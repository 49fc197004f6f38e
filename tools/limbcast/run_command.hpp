#pragma once

#include "common/service/service_command_line.hpp"
#include "tools/limbcast/sub_command.hpp"

namespace limbcast::tool {

/// `limbcast run`: gateway, fusion and posture in one process.
[[nodiscard]] SubCommand AddRunCommand(service::ServiceCommandLine& line);

}  // namespace limbcast::tool
