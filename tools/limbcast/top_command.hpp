#pragma once

#include "common/service/service_command_line.hpp"
#include "tools/limbcast/sub_command.hpp"

namespace limbcast::tool {

/// `limbcast top`: a live table of processes, bodies and segments.
[[nodiscard]] SubCommand AddTopCommand(service::ServiceCommandLine& line);

}  // namespace limbcast::tool
