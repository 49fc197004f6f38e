#include "common/bus/network_interfaces.hpp"

#include <arpa/inet.h>
#include <ifaddrs.h>
#include <net/if.h>
#include <netdb.h>
#include <sys/socket.h>

#include <algorithm>
#include <array>
#include <cstring>

namespace limbcast::bus {
namespace {

std::string Joined(const std::vector<std::string>& texts) {
  std::string joined;
  for (const std::string& text : texts) {
    joined += (joined.empty() ? "" : ",") + text;
  }
  return joined;
}

std::string PeersText(const BusConfig& config) {
  if (!config.peers.empty()) {
    return ", peers " + Joined(config.peers);
  }
  return config.network == NetworkProfile::kLoopback ? "" : ", peers by multicast";
}

}  // namespace

std::string Ipv4Text(const in_addr& address) {
  std::array<char, INET_ADDRSTRLEN> text{};
  inet_ntop(AF_INET, &address, text.data(), text.size());
  return text.data();
}

std::optional<in_addr> ResolveIpv4(const std::string& host) {
  addrinfo hints{};
  hints.ai_family = AF_INET;
  hints.ai_socktype = SOCK_DGRAM;
  addrinfo* found = nullptr;
  if (getaddrinfo(host.c_str(), nullptr, &hints, &found) != 0) {
    return std::nullopt;
  }
  sockaddr_in address{};
  std::memcpy(&address, found->ai_addr, sizeof address);
  freeaddrinfo(found);
  return address.sin_addr;
}

std::vector<NetworkInterface> HostInterfaces() {
  std::vector<NetworkInterface> found;
  ifaddrs* list = nullptr;
  if (getifaddrs(&list) != 0) {
    return found;
  }
  for (const ifaddrs* it = list; it != nullptr; it = it->ifa_next) {
    if (it->ifa_addr == nullptr || it->ifa_addr->sa_family != AF_INET) {
      continue;
    }
    sockaddr_in address{};
    std::memcpy(&address, it->ifa_addr, sizeof address);
    found.push_back({.name = it->ifa_name,
                     .address = Ipv4Text(address.sin_addr),
                     .up = (it->ifa_flags & IFF_UP) != 0 && (it->ifa_flags & IFF_RUNNING) != 0,
                     .loopback = (it->ifa_flags & IFF_LOOPBACK) != 0,
                     .multicast = (it->ifa_flags & IFF_MULTICAST) != 0});
  }
  freeifaddrs(list);
  return found;
}

std::vector<NetworkInterface> UsedInterfaces(const BusConfig& config,
                                             const std::vector<NetworkInterface>& host) {
  std::vector<NetworkInterface> used;
  for (const NetworkInterface& interface : host) {
    const bool named =
        std::any_of(config.interfaces.begin(), config.interfaces.end(),
                    [&](const std::string& wanted) { return interface.IsCalled(wanted); });
    const bool uses =
        config.network == NetworkProfile::kLoopback
            ? interface.loopback
            : (config.interfaces.empty() ? interface.up && !interface.loopback : named);
    if (uses) {
      used.push_back(interface);
    }
  }
  return used;
}

std::string DescribeNetwork(const BusConfig& config, const std::vector<NetworkInterface>& host) {
  if (config.network == NetworkProfile::kLoopback) {
    return "loopback only" + PeersText(config);
  }
  std::string names;
  const std::vector<NetworkInterface> used = UsedInterfaces(config, host);
  for (const NetworkInterface& interface : used) {
    names += (names.empty() ? "" : ", ") + interface.name + ' ' + interface.address;
  }
  const bool library_chooses =
      config.vendor == Vendor::kCyclone && config.interfaces.empty() && used.size() > 1;
  return std::string(config.network == NetworkProfile::kWifi ? "wifi" : "lan") +
         (library_chooses ? " on one of " : " on ") + (names.empty() ? "no interface" : names) +
         PeersText(config);
}

}  // namespace limbcast::bus
