#pragma once

#include "common/service/service_command_line.hpp"
#include "tools/limbcast/sub_command.hpp"

namespace limbcast::tool {

/// `limbcast echo TOPIC`: each sample of a topic as one line of JSON, until Ctrl-C or --count.
[[nodiscard]] SubCommand AddEchoCommand(service::ServiceCommandLine& line);

}  // namespace limbcast::tool
