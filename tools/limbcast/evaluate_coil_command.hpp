#pragma once

#include "tools/limbcast/sub_command.hpp"

namespace limbcast::tool {

/// `limbcast evaluate coil`: the coil tracker, alone and with inertial sensors, in the experiments
/// it was published with. `evaluate` is the word that it follows.
[[nodiscard]] SubCommand AddEvaluateCoil(CLI::App& evaluate);

}  // namespace limbcast::tool
