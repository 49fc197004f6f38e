#pragma once

#include "tools/limbcast/sub_command.hpp"

namespace limbcast::tool {

/// `limbcast evaluate gaps`: how well gaps of an optical marker are filled, and how few markers are
/// enough. `evaluate` is the word that it follows.
[[nodiscard]] SubCommand AddEvaluateGaps(CLI::App& evaluate);

}  // namespace limbcast::tool
