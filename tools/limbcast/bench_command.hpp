#pragma once

#include "tools/limbcast/sub_command.hpp"

namespace limbcast::tool {

/// `limbcast bench users`.
[[nodiscard]] SubCommand AddBenchCommand(service::ServiceCommandLine& line);

}  // namespace limbcast::tool
