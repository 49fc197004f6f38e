#pragma once

#include <span>
#include <string>

#include "common/filters/position/optical_inertial_config.hpp"

namespace limbcast::tool {

/// The defaults of the inertial + optical filter changed by "key=value" texts of a command line.
[[nodiscard]] Result<filters::OpticalInertialConfig> PositionConfigFrom(
    std::span<const std::string> texts);

}  // namespace limbcast::tool
