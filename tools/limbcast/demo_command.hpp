#pragma once

#include "common/service/service_command_line.hpp"
#include "tools/limbcast/sub_command.hpp"

namespace limbcast::tool {

/// `limbcast demo`: runs the three services as separate processes on this host, looks on as a
/// client, and sums up.
[[nodiscard]] SubCommand AddDemoCommand(service::ServiceCommandLine& line);

}  // namespace limbcast::tool
