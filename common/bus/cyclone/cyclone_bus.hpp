#pragma once

#include <memory>

#include "common/base/result.hpp"
#include "common/bus/bus.hpp"
#include "common/bus/bus_config.hpp"
#include "common/bus/events.hpp"

namespace limbcast::bus::cyclone {

/// A bus on Cyclone DDS, as Open (bus_factory.hpp) describes it. `config` is valid.
[[nodiscard]] Result<std::unique_ptr<Bus>> OpenCyclone(const BusConfig& config,
                                                       BusEventHandler on_event);

}  // namespace limbcast::bus::cyclone
