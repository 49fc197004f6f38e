#include "common/bus/fastdds/fast_network.hpp"

#include <fastrtps/utils/IPLocator.h>
#include <gtest/gtest.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <unistd.h>

#include <set>

#include <fastdds/rtps/transport/ChainingTransportDescriptor.h>
#include <fastdds/rtps/transport/UDPv4TransportDescriptor.h>

namespace limbcast::bus::fastdds {
namespace {

using eprosima::fastdds::rtps::ChainingTransportDescriptor;
using eprosima::fastdds::rtps::UDPv4TransportDescriptor;
using eprosima::fastrtps::rtps::IPLocator;

std::vector<std::string> InitialPeers(const eprosima::fastdds::dds::DomainParticipantQos& qos) {
  std::vector<std::string> peers;
  for (const auto& locator : qos.wire_protocol().builtin.initialPeersList) {
    peers.push_back(IPLocator::toIPv4string(locator));
  }
  return peers;
}

TEST(FastNetworkTest, LoopbackIsUdpOn127AndNothingElse) {
  const BusConfig config;
  const auto addresses = InterfaceAddresses(config);
  ASSERT_TRUE(addresses);
  EXPECT_EQ(*addresses, std::vector<std::string>{"127.0.0.1"});
  const auto qos = ParticipantQos(config, *addresses);
  ASSERT_TRUE(qos);
  EXPECT_FALSE(qos->transport().use_builtin_transports);
  ASSERT_EQ(qos->transport().user_transports.size(), 1U);
  const auto chain = std::dynamic_pointer_cast<ChainingTransportDescriptor>(
      qos->transport().user_transports.front());
  ASSERT_NE(chain, nullptr);
  const auto udp = std::dynamic_pointer_cast<UDPv4TransportDescriptor>(chain->low_level_descriptor);
  ASSERT_NE(udp, nullptr);
  EXPECT_EQ(udp->interfaceWhiteList, *addresses);
  EXPECT_EQ(udp->maxInitialPeersRange, 64U);
  EXPECT_EQ(InitialPeers(*qos), std::vector<std::string>{"127.0.0.1"});
}

TEST(FastNetworkTest, AnInterfaceIsFoundByNameOrAddress) {
  BusConfig config;
  config.network = NetworkProfile::kInterfaces;
  for (const char* name : {"lo", "127.0.0.1"}) {
    config.interfaces = {name};
    const auto addresses = InterfaceAddresses(config);
    ASSERT_TRUE(addresses) << addresses.error().message;
    EXPECT_EQ(*addresses, std::vector<std::string>{"127.0.0.1"});
  }
}

TEST(FastNetworkTest, AMissingInterfaceIsNamed) {
  BusConfig config;
  config.network = NetworkProfile::kInterfaces;
  config.interfaces = {"lo", "nosuch0"};
  const auto addresses = InterfaceAddresses(config);
  ASSERT_FALSE(addresses);
  EXPECT_EQ(addresses.error().code, ErrorCode::kUnavailable);
  EXPECT_NE(addresses.error().message.find("nosuch0"), std::string::npos);
}

TEST(FastNetworkTest, PeersOnALanAreCalledBesideTheDiscoveryGroup) {
  BusConfig config;
  config.network = NetworkProfile::kLan;
  EXPECT_TRUE(InitialPeers(*ParticipantQos(config, {})).empty()) << "the library's own group";
  config.peers = {"127.0.0.3"};
  EXPECT_EQ(InitialPeers(*ParticipantQos(config, {})),
            (std::vector<std::string>{"239.255.0.1", "127.0.0.3"}));
}

TEST(FastNetworkTest, PeersOnAWifiAreCalledWithoutTheDiscoveryGroup) {
  BusConfig config;
  config.network = NetworkProfile::kWifi;
  config.peers = {"127.0.0.3"};
  EXPECT_EQ(InitialPeers(*ParticipantQos(config, {})), std::vector<std::string>{"127.0.0.3"});
}

TEST(FastNetworkTest, APeerWithoutAnAddressIsNamed) {
  BusConfig config;
  config.peers = {"no.such.host.invalid"};
  const auto qos = ParticipantQos(config, {"127.0.0.1"});
  ASSERT_FALSE(qos);
  EXPECT_NE(qos.error().message.find("no.such.host.invalid"), std::string::npos);
}

TEST(FastNetworkTest, OnASecuredNetworkThePortOfALeftParticipantStaysEmptyForAWhile) {
  BusConfig config;
  config.domain_id = 97;
  config.security_dir = "/some/folder";
  std::set<std::int32_t> numbers;
  for (int i = 0; i < 50; ++i) {  // of 64; a few may be others'
    const std::int32_t number = ParticipantNumber(config).value();
    EXPECT_TRUE(numbers.insert(number).second) << number << " was used just before";
    EXPECT_LT(number, 64) << "or peers do not call it";
  }
}

TEST(FastNetworkTest, OnASecuredNetworkANumberWhosePortIsTakenIsPassedOver) {
  BusConfig config;
  config.domain_id = 96;
  config.security_dir = "/some/folder";
  const int fd = socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC, 0);
  std::int32_t taken = 0;
  int bound = -1;
  for (int attempt = 0; bound != 0 && attempt < 60; ++attempt) {  // some may be somebody else's
    taken = (ParticipantNumber(config).value() + 1) % 64;
    sockaddr_in address{};
    address.sin_family = AF_INET;
    address.sin_addr.s_addr = htonl(INADDR_ANY);
    address.sin_port = htons(static_cast<std::uint16_t>(7400 + 250 * 96 + 10 + 2 * taken));
    // NOLINTNEXTLINE(*-reinterpret-cast): the interface of bind
    bound = bind(fd, reinterpret_cast<const sockaddr*>(&address), sizeof address);
  }
  ASSERT_EQ(bound, 0);
  const std::int32_t next = ParticipantNumber(config).value();
  EXPECT_NE(next, taken);
  EXPECT_NE(ParticipantNumber(config).value(), next) << "the library would take it for the taken";
  close(fd);
}

TEST(FastNetworkTest, ParticipantNumbersAreUsedAgainAndGuidPrefixesAreNot) {
  std::int32_t first = -1;
  {
    const ParticipantNumber a;
    const ParticipantNumber b;
    EXPECT_NE(a.value(), b.value());
    first = a.value();
  }
  EXPECT_EQ(ParticipantNumber().value(), first);
  const BusConfig config;
  EXPECT_FALSE(ParticipantQos(config, {"127.0.0.1"})->wire_protocol().prefix ==
               ParticipantQos(config, {"127.0.0.1"})->wire_protocol().prefix);
}

}  // namespace
}  // namespace limbcast::bus::fastdds
