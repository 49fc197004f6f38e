#pragma once

#include <memory>
#include <string>

#include "common/base/clock.hpp"
#include "common/bus/bus.hpp"
#include "common/bus/bus_config.hpp"

namespace limbcast::bus::inproc {

/// Connects inproc buses: one domain. Thread-safe.
class Hub;

/// A hub of its own, for a test. `clock` gives SampleInfo::received_at; nullptr = the system clock.
[[nodiscard]] std::shared_ptr<Hub> MakeHub(const Clock* clock = nullptr);

/// The hub that all buses of this process with this domain share while one of them lives.
[[nodiscard]] std::shared_ptr<Hub> SharedHub(std::uint32_t domain_id);

/// A bus without a network: Write runs the handlers of all matching readers on the writing thread
/// before it returns, in the order in which the readers were made, so a test is deterministic. (A
/// handler that is already running gets the value after its current call.) Late joiners on state
/// topics, partitions with wildcards, exclusive ownership, dispose, matching and bounds are as on
/// DDS; nothing is ever lost. Destroying a writer counts as gone at once. Uses partition and
/// ownership_strength of `config`.
[[nodiscard]] std::unique_ptr<Bus> MakeBus(std::shared_ptr<Hub> hub, const BusConfig& config = {},
                                           BusEventHandler on_event = {});

}  // namespace limbcast::bus::inproc
