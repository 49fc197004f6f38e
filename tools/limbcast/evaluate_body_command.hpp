#pragma once

#include <CLI/CLI.hpp>

#include "tools/limbcast/sub_command.hpp"

namespace limbcast::tool {

/// `limbcast evaluate body`: a recording of a whole person through fusion and posture, calibrated
/// by itself or from a given moment, with its figures and a page of plots.
[[nodiscard]] SubCommand AddEvaluateBody(CLI::App& evaluate);

}  // namespace limbcast::tool
