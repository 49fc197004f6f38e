#pragma once

#include "tools/limbcast/sub_command.hpp"

namespace limbcast::tool {

/// `limbcast coil plan`: how many sources of coils fit into one room.
[[nodiscard]] SubCommand AddCoilCommand(service::ServiceCommandLine& line);

}  // namespace limbcast::tool
