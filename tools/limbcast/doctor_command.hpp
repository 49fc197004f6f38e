#pragma once

#include "tools/limbcast/sub_command.hpp"

namespace limbcast::tool {

/// `limbcast doctor`: what is wrong with the network, and what to do.
[[nodiscard]] SubCommand AddDoctorCommand(service::ServiceCommandLine& line);

}  // namespace limbcast::tool
