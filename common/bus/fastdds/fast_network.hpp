#pragma once

#include <fastdds/dds/domain/qos/DomainParticipantQos.hpp>
#include <string>
#include <vector>

#include "common/base/result.hpp"
#include "common/bus/bus_config.hpp"

namespace limbcast::bus::fastdds {

/// The IPv4 addresses of the interfaces that `config` names (empty = all of them). Fails with
/// kUnavailable naming the interface that this host does not have.
[[nodiscard]] Result<std::vector<std::string>> InterfaceAddresses(const BusConfig& config);

/// How a participant of `config` reaches the others: UDPv4 only (no shared memory), the interfaces
/// and the peers of `config`. `addresses` come from InterfaceAddresses.
[[nodiscard]] Result<eprosima::fastdds::dds::DomainParticipantQos> ParticipantQos(
    const BusConfig& config, const std::vector<std::string>& addresses);

}  // namespace limbcast::bus::fastdds
