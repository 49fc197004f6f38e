#pragma once

#include <CLI/CLI.hpp>

#include "tools/limbcast/sub_command.hpp"

namespace limbcast::tool {

/// `limbcast evaluate published`: the experiments of the publications that the filters come from,
/// simulated with a published seed, beside the published figures.
SubCommand AddEvaluatePublishedCommand(CLI::App& evaluate);

}  // namespace limbcast::tool
