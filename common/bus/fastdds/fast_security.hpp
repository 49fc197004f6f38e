#pragma once

#include <fastdds/dds/domain/qos/DomainParticipantQos.hpp>

#include "common/base/result.hpp"
#include "common/bus/bus_config.hpp"

namespace limbcast::bus::fastdds {

/// Adds to the QoS of a participant what DDS Security needs; nothing without security. Fails with
/// kUnsupported when the library was built without it: it would join in the clear and say nothing.
[[nodiscard]] Status AddSecurity(const BusConfig& config,
                                 eprosima::fastdds::dds::DomainParticipantQos& qos);

}  // namespace limbcast::bus::fastdds
