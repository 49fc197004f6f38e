#pragma once

#include "tools/limbcast/sub_command.hpp"

namespace limbcast::tool {

/// `limbcast security`: makes, renews and lists the credentials of a secured network.
[[nodiscard]] SubCommand AddSecurityCommand(service::ServiceCommandLine& line);

}  // namespace limbcast::tool
