#pragma once

#include "tools/limbcast/sub_command.hpp"

namespace limbcast::tool {

/// `limbcast session list|create|join|leave|close`: what a session host serves.
[[nodiscard]] SubCommand AddSessionCommand(service::ServiceCommandLine& line);

}  // namespace limbcast::tool
