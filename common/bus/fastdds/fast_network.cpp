#include "common/bus/fastdds/fast_network.hpp"

#include <arpa/inet.h>
#include <fastrtps/utils/IPLocator.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <unistd.h>

#include <fastdds/rtps/transport/UDPv4TransportDescriptor.h>
#include <algorithm>
#include <memory>
#include <mutex>
#include <random>
#include <set>
#include <utility>

#include "common/bus/fastdds/fast_transport.hpp"
#include "common/bus/network_interfaces.hpp"

namespace limbcast::bus::fastdds {
namespace {

using eprosima::fastdds::dds::DomainParticipantQos;
using eprosima::fastdds::rtps::UDPv4TransportDescriptor;
using eprosima::fastrtps::Duration_t;
using eprosima::fastrtps::rtps::IPLocator;
using eprosima::fastrtps::rtps::Locator_t;

constexpr std::uint32_t kSocketBuffer_bytes = 4 * 1024 * 1024;  // the kernel caps it at rmem_max
constexpr std::uint32_t kPeerPorts = 64;  // participants that one address may have
constexpr const char* kLoopback = "127.0.0.1";
constexpr const char* kDiscoveryGroup = "239.255.0.1";  // DDSI-RTPS 9.6.1.4

// Numbers are used again, so names must not be: a peer that has not yet heard of our last
// participant's end would take the new one for it.
void SetUniqueGuidPrefix(DomainParticipantQos& qos) {
  auto& prefix = qos.wire_protocol().prefix;
  std::random_device random;
  for (std::size_t i = 0; i < prefix.size; ++i) {
    prefix.value[i] = static_cast<eprosima::fastrtps::rtps::octet>(random());
  }
  prefix.value[0] = 0x01;  // vendor id of eProsima, DDSI-RTPS 9.3.1.5
  prefix.value[1] = 0x0F;
}

struct NumbersInUse {
  std::mutex mutex;
  std::set<std::int32_t> numbers;
  std::int32_t next_secured = getpid();
};
NumbersInUse& TheNumbersInUse() {
  static auto* in_use = new NumbersInUse();  // NOLINT: buses may be static objects
  return *in_use;
}

void AddPeer(DomainParticipantQos& qos, const std::string& address) {
  Locator_t locator;  // port 0: the first kPeerPorts discovery ports of the domain
  locator.port = 0;
  IPLocator::setIPv4(locator, address);
  qos.wire_protocol().builtin.initialPeersList.push_back(locator);
}

}  // namespace

Result<std::vector<std::string>> InterfaceAddresses(const BusConfig& config) {
  if (config.network == NetworkProfile::kLoopback) {
    return std::vector<std::string>{kLoopback};
  }
  std::vector<std::string> addresses;  // stays empty without names
  const std::vector<NetworkInterface> known = HostInterfaces();
  for (const std::string& wanted : config.interfaces) {
    const auto it =
        std::find_if(known.begin(), known.end(),
                     [&](const NetworkInterface& interface) { return interface.IsCalled(wanted); });
    if (it == known.end()) {
      return Error{ErrorCode::kUnavailable,
                   "network interface '" + wanted + "' does not exist on this host or has no IPv4"};
    }
    addresses.push_back(it->address);
  }
  return addresses;
}

Result<DomainParticipantQos> ParticipantQos(const BusConfig& config,
                                            const std::vector<std::string>& addresses) {
  DomainParticipantQos qos;
  qos.name(config.participant_name);

  SetUniqueGuidPrefix(qos);
  auto udp = std::make_shared<UDPv4TransportDescriptor>();
  udp->sendBufferSize = kSocketBuffer_bytes;
  udp->receiveBufferSize = kSocketBuffer_bytes;
  udp->maxInitialPeersRange = kPeerPorts;
  udp->interfaceWhiteList = addresses;
  qos.transport().use_builtin_transports = false;  // they bring shared memory
  qos.transport().user_transports.push_back(WithoutKeysOfFragments(udp));

  const bool loopback = config.network == NetworkProfile::kLoopback;
  if (loopback) {
    AddPeer(qos, kLoopback);
  } else if (!config.peers.empty() && config.network != NetworkProfile::kWifi) {
    AddPeer(qos, kDiscoveryGroup);  // a list of peers replaces the group unless it is in it
  }
  for (const std::string& peer : config.peers) {
    const auto address = ResolveIpv4(peer);
    if (!address) {
      return Error{ErrorCode::kUnavailable, "bus.peers: no IPv4 address for '" + peer + "'"};
    }
    AddPeer(qos, Ipv4Text(*address));
  }

  auto& discovery = qos.wire_protocol().builtin.discovery_config;
  discovery.initial_announcements.count = 20;
  discovery.initial_announcements.period = Duration_t(0.05);
  discovery.leaseDuration = Duration_t(10, 0);  // as Cyclone DDS
  discovery.leaseDuration_announcementperiod = loopback ? Duration_t(0.5) : Duration_t(2, 0);
  return qos;
}

namespace {

constexpr std::uint32_t FirstPort(std::uint32_t domain_id) { return 7400 + 250 * domain_id + 10; }

bool IsFree(std::uint32_t port) {
  const int fd = socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC, 0);
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_addr.s_addr = htonl(INADDR_ANY);
  address.sin_port = htons(static_cast<std::uint16_t>(port));
  // NOLINTNEXTLINE(*-reinterpret-cast): the interface of bind
  const bool bound = bind(fd, reinterpret_cast<const sockaddr*>(&address), sizeof address) == 0;
  close(fd);
  return bound;
}

// Two unicast ports for each participant number, DDSI-RTPS 2.2, 9.6.1.1.
bool HasFreePorts(std::uint32_t domain_id, std::uint32_t number) {
  const std::uint32_t first = FirstPort(domain_id) + 2 * number;
  return IsFree(first) && IsFree(first + 1);
}

}  // namespace

Status CheckFreePorts(const BusConfig& config) {
  const std::uint32_t first = FirstPort(config.domain_id);
  for (std::uint32_t number = 0; number < kPeerPorts; ++number) {
    if (HasFreePorts(config.domain_id, number)) {
      return Ok();
    }
  }
  return Error{ErrorCode::kUnavailable,
               "no free port in domain " + std::to_string(config.domain_id) + ": UDP " +
                   std::to_string(first) + " to " + std::to_string(first + 2 * kPeerPorts - 1) +
                   " are in use"};
}

ParticipantNumber::ParticipantNumber(const BusConfig& config) {
  constexpr auto kSpread = static_cast<std::int32_t>(kPeerPorts);
  NumbersInUse& in_use = TheNumbersInUse();
  const std::lock_guard lock(in_use.mutex);
  if (!config.security_dir.empty()) {
    value_ = in_use.next_secured % kSpread;
    for (std::int32_t i = 0;
         i < kSpread && (in_use.numbers.contains(value_) ||
                         !HasFreePorts(config.domain_id, static_cast<std::uint32_t>(value_)));
         ++i) {
      value_ = (value_ + 1) % kSpread;
    }
    in_use.next_secured = value_ + 1;
  }
  while (!in_use.numbers.insert(value_).second) {
    ++value_;
  }
}

ParticipantNumber::~ParticipantNumber() {
  NumbersInUse& in_use = TheNumbersInUse();
  const std::lock_guard lock(in_use.mutex);
  in_use.numbers.erase(value_);
}

}  // namespace limbcast::bus::fastdds
