#pragma once

#include <dds/dds.h>

#include "common/base/result.hpp"
#include "common/bus/bus_config.hpp"

namespace limbcast::bus::cyclone {

/// Adds to the QoS of a participant what DDS Security needs; nothing without security. Fails with
/// kUnsupported when the library's security plugins are not installed.
[[nodiscard]] Status AddSecurity(const BusConfig& config, dds_qos_t* qos);

}  // namespace limbcast::bus::cyclone
