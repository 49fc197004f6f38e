#pragma once

#include <cstdint>
#include <fastdds/dds/publisher/qos/DataWriterQos.hpp>
#include <fastdds/dds/subscriber/qos/DataReaderQos.hpp>
#include <string_view>

#include "common/bus/bus_config.hpp"
#include "common/bus/qos.hpp"

namespace limbcast::bus::fastdds {

/// The QoS of a topic by its purpose; every policy that matters is set, none is left to a default
/// of the library. `exclusive` = EXCLUSIVE ownership with the strength of `config`.
[[nodiscard]] eprosima::fastdds::dds::DataWriterQos WriterQos(QosProfile profile, bool exclusive,
                                                              const BusConfig& config);
[[nodiscard]] eprosima::fastdds::dds::DataReaderQos ReaderQos(QosProfile profile, bool exclusive,
                                                              const BusConfig& config);

/// Name of a policy by its number in the DDS specification: "liveliness", "ownership", ...
[[nodiscard]] std::string_view PolicyName(std::uint32_t policy_id);

}  // namespace limbcast::bus::fastdds
