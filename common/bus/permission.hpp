#pragma once

#include <string>
#include <string_view>

#include "common/base/result.hpp"
#include "common/bus/bus_config.hpp"

namespace limbcast::bus {

/// What a DDS library's refusal of a writer or reader ("publish" or "subscribe") means when the bus
/// is secured: `refused` with the role named in front when the role may not do that, else `refused`
/// as it is.
[[nodiscard]] Error ExplainRefusal(const BusConfig& config, std::string_view verb,
                                   std::string_view short_topic, Error refused);

}  // namespace limbcast::bus
