#include "tools/limbcast/demo/free_domain.hpp"

#include <algorithm>
#include <charconv>
#include <fstream>
#include <random>
#include <sstream>
#include <string>

namespace limbcast::tool {

namespace {
constexpr std::uint32_t kDomains = 102;
constexpr std::uint32_t kPortBase = 7400;
constexpr std::uint32_t kPortsPerDomain = 250;
}  // namespace

std::vector<std::uint16_t> ParseUdpPorts(std::string_view proc_net_udp) {
  std::vector<std::uint16_t> ports;
  std::istringstream lines{std::string(proc_net_udp)};
  std::string line;
  while (std::getline(lines, line)) {
    // "  12: 0100007F:1CE9 00000000:0000 07 ...": slot, local address and port in hex, ...
    std::istringstream fields(line);
    std::string slot;
    std::string local;
    fields >> slot >> local;
    const auto colon = local.rfind(':');
    unsigned port = 0;
    if (colon != std::string::npos &&
        std::from_chars(local.data() + colon + 1, local.data() + local.size(), port, 16).ec ==
            std::errc{}) {
      ports.push_back(static_cast<std::uint16_t>(port));
    }
  }
  return ports;
}

Result<std::uint32_t> FindFreeDomain(const std::vector<std::uint16_t>& used_ports,
                                     std::uint32_t seed) {
  for (std::uint32_t i = 0; i < kDomains; ++i) {
    const std::uint32_t domain = (seed + i) % kDomains;
    const std::uint32_t first = kPortBase + kPortsPerDomain * domain;
    const bool used = std::any_of(used_ports.begin(), used_ports.end(), [&](std::uint16_t port) {
      return port >= first && port < first + kPortsPerDomain;
    });
    if (!used) {
      return domain;
    }
  }
  return Error{ErrorCode::kUnavailable, "every DDS domain in [0, 101] is in use on this host"};
}

Result<std::uint32_t> FindFreeDomain() {
  std::ifstream file("/proc/net/udp");
  std::ostringstream text;
  text << file.rdbuf();
  return FindFreeDomain(ParseUdpPorts(text.str()), std::random_device{}());
}

}  // namespace limbcast::tool
