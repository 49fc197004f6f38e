#pragma once

#include <memory>

#include "common/base/result.hpp"
#include "common/bus/bus.hpp"
#include "common/bus/bus_config.hpp"
#include "common/bus/events.hpp"

namespace limbcast::bus::fastdds {

/// A bus on Fast DDS, as Open (bus_factory.hpp) describes it. `config` is valid.
[[nodiscard]] Result<std::unique_ptr<Bus>> OpenFast(const BusConfig& config,
                                                    BusEventHandler on_event);

}  // namespace limbcast::bus::fastdds
