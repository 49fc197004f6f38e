#pragma once

#include <CLI/CLI.hpp>

#include "tools/limbcast/sub_command.hpp"

namespace limbcast::tool {

/// `limbcast calibrate body`: leads a person through the alignment of the worn sensors: reference
/// pose, walk, profile.
[[nodiscard]] SubCommand AddCalibrateBody(CLI::App& calibrate, service::ServiceCommandLine& line);

}  // namespace limbcast::tool
