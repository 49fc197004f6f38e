#pragma once

#include <cstdint>
#include <string_view>
#include <vector>

#include "common/base/result.hpp"

namespace limbcast::tool {

/// Local UDP ports in use, from the text of /proc/net/udp.
[[nodiscard]] std::vector<std::uint16_t> ParseUdpPorts(std::string_view proc_net_udp);

/// A DDS domain of which no port is in `used_ports`, tried from `seed` on. Fails with kUnavailable
/// when all 102 are in use. Ports of domain d: 7400 + 250 d up to 249 more
/// (DDSI-RTPS 2.2, 9.6.1.1).
[[nodiscard]] Result<std::uint32_t> FindFreeDomain(const std::vector<std::uint16_t>& used_ports,
                                                   std::uint32_t seed);

/// The same for this host now.
[[nodiscard]] Result<std::uint32_t> FindFreeDomain();

}  // namespace limbcast::tool
