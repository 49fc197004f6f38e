#pragma once

#include <memory>

#include "common/bus/bus.hpp"

namespace limbcast::bus {

/// Joins the network that `config` describes. `on_event` may be empty; it outlives nothing and is
/// called from middleware threads until the bus is destroyed. Fails with kInvalidArgument (a value
/// of `config`), kUnavailable (no participant: interface, port or participant index not free) or
/// kUnsupported. Vendor::kInproc joins the bus that all inproc buses of this process with the same
/// domain and partition share.
[[nodiscard]] Result<std::unique_ptr<Bus>> Open(const BusConfig& config,
                                                BusEventHandler on_event = {});

}  // namespace limbcast::bus
