#pragma once

#include <netinet/in.h>

#include <optional>
#include <string>
#include <vector>

#include "common/bus/bus_config.hpp"

namespace limbcast::bus {

/// One IPv4 address of this host.
struct NetworkInterface {
  std::string name;     ///< "eth0"
  std::string address;  ///< "10.0.0.5"
  bool up = false;
  bool loopback = false;
  bool multicast = false;
  bool operator==(const NetworkInterface&) const = default;

  /// By its name or by its address.
  [[nodiscard]] bool IsCalled(const std::string& wanted) const {
    return name == wanted || address == wanted;
  }
};

/// "10.0.0.5".
[[nodiscard]] std::string Ipv4Text(const in_addr& address);

/// The IPv4 address of a host name or address; nothing when there is none.
[[nodiscard]] std::optional<in_addr> ResolveIpv4(const std::string& host);

/// In the order of the system; empty when it refuses.
[[nodiscard]] std::vector<NetworkInterface> HostInterfaces();

/// Those that `config` uses: the named ones, or on a lan or Wi-Fi without names all that are up and
/// leave the host (of these Cyclone DDS chooses one).
[[nodiscard]] std::vector<NetworkInterface> UsedInterfaces(
    const BusConfig& config, const std::vector<NetworkInterface>& host);

/// Profile, interfaces and peers for a log: "wifi on wlan0 10.0.0.5, peers 10.0.0.7".
[[nodiscard]] std::string DescribeNetwork(const BusConfig& config,
                                          const std::vector<NetworkInterface>& host);

}  // namespace limbcast::bus
