#pragma once

#include <dds/dds.h>

#include <cstdint>
#include <memory>
#include <string_view>

#include "common/bus/bus_config.hpp"
#include "common/bus/qos.hpp"

namespace limbcast::bus::cyclone {

struct DeleteQos {
  void operator()(dds_qos_t* qos) const { dds_delete_qos(qos); }
};
using Qos = std::unique_ptr<dds_qos_t, DeleteQos>;

/// The QoS of a reader or writer by the purpose of its topic; every policy that matters is set,
/// none is left to a default of the library. `exclusive` = EXCLUSIVE ownership, for a writer with
/// the strength of `config`.
[[nodiscard]] Qos WriterQos(QosProfile profile, bool exclusive, const BusConfig& config);
[[nodiscard]] Qos ReaderQos(QosProfile profile, bool exclusive, const BusConfig& config);

/// The QoS of the publisher and subscriber: the partition.
[[nodiscard]] Qos GroupQos(const BusConfig& config);

/// Name of a policy by its number in the DDS specification: "liveliness", "ownership", ...
[[nodiscard]] std::string_view PolicyName(std::uint32_t policy_id);

}  // namespace limbcast::bus::cyclone
