#pragma once

#include "common/service/service_command_line.hpp"
#include "tools/limbcast/sub_command.hpp"

namespace limbcast::tool {

/// `limbcast export angles`: the joint angles of a person of a running pipeline, to a file.
[[nodiscard]] SubCommand AddExportCommand(service::ServiceCommandLine& line);

}  // namespace limbcast::tool
