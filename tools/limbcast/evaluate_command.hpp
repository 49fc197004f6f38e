#pragma once

#include "tools/limbcast/sub_command.hpp"

namespace limbcast::tool {

/// `limbcast evaluate orientation`: runs filters over recordings with truth, offline and as fast as
/// possible, through the very filters of the fusion service, and reports BROAD's errors.
SubCommand AddEvaluateCommand(service::ServiceCommandLine& line);

}  // namespace limbcast::tool
