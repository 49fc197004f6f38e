#include "common/bus/cyclone/cyclone_domain.hpp"

#include <gtest/gtest.h>

#include "tests/unit/common/bus/test_domain.hpp"

namespace limbcast::bus::cyclone {
namespace {

using testing::LoopbackConfig;

bool Contains(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

TEST(CycloneDomainXmlTest, LoopbackNeitherLeavesTheHostNorUsesMulticast) {
  const std::string xml = DomainXml({.domain_id = 2});
  EXPECT_TRUE(Contains(xml, "<NetworkInterface name=\"lo\" multicast=\"false\"/>")) << xml;
  EXPECT_TRUE(Contains(xml, "<AllowMulticast>false</AllowMulticast>")) << xml;
  EXPECT_TRUE(Contains(xml, "<SPDPInterval>200ms</SPDPInterval>")) << xml;
  // Domain 2: ports from 7400 + 2 * 250 + 10.
  EXPECT_TRUE(Contains(xml, "<Peer address=\"127.0.0.1:7910\"/>")) << xml;
  EXPECT_TRUE(Contains(xml, "<Peer address=\"127.0.0.1:7988\"/>")) << xml;
  EXPECT_FALSE(Contains(xml, "127.0.0.1:7990")) << xml;
}

TEST(CycloneDomainXmlTest, LanLetsTheLibraryChooseAndCallsTheNamedPeers) {
  const std::string xml = DomainXml(
      {.domain_id = 0, .network = NetworkProfile::kLan, .peers = {"10.0.0.7", "10.0.0.8:7412"}});
  EXPECT_FALSE(Contains(xml, "<Interfaces>")) << xml;
  EXPECT_TRUE(Contains(xml, "<AllowMulticast>spdp</AllowMulticast>")) << xml;
  EXPECT_TRUE(Contains(xml, "<Peer address=\"10.0.0.7:7410\"/>")) << xml;
  EXPECT_TRUE(Contains(xml, "<Peer address=\"10.0.0.7:7440\"/>")) << xml;
  EXPECT_FALSE(Contains(xml, "10.0.0.7:7442")) << xml;
  EXPECT_TRUE(Contains(xml, "<Peer address=\"10.0.0.8:7412\"/>")) << xml;
  EXPECT_FALSE(Contains(xml, "127.0.0.1")) << xml;
}

TEST(CycloneDomainXmlTest, InterfacesAreGivenByNameOrAddress) {
  const std::string xml =
      DomainXml({.network = NetworkProfile::kInterfaces, .interfaces = {"eth1", "10.1.2.3"}});
  EXPECT_TRUE(Contains(xml,
                       "<Interfaces><NetworkInterface name=\"eth1\"/>"
                       "<NetworkInterface address=\"10.1.2.3\"/></Interfaces>"))
      << xml;
}

TEST(CycloneDomainXmlTest, WifiSendsNoDataByMulticastAndAnnouncesByItOnlyWithoutPeers) {
  BusConfig config{.network = NetworkProfile::kWifi, .interfaces = {"wlan0"}};
  EXPECT_TRUE(Contains(DomainXml(config), "<AllowMulticast>spdp</AllowMulticast>"));
  EXPECT_TRUE(Contains(DomainXml(config), "<NetworkInterface name=\"wlan0\"/>"));
  config.peers = {"10.0.0.7"};
  EXPECT_TRUE(Contains(DomainXml(config), "<AllowMulticast>false</AllowMulticast>"));
  EXPECT_TRUE(Contains(DomainXml(config), "<Peer address=\"10.0.0.7:"));
}

TEST(CycloneDomainXmlTest, KeyHashesTravelBecauseFastDdsNeedsThemToDispose) {
  EXPECT_TRUE(Contains(DomainXml({}), "<GenerateKeyhash>true</GenerateKeyhash>"));
}

TEST(CycloneDomainXmlTest, BatchingIsAsConfigured) {
  EXPECT_TRUE(Contains(DomainXml({}), "<WriteBatch>false</WriteBatch>"));
  EXPECT_TRUE(Contains(DomainXml({.write_batching = true}), "<WriteBatch>true</WriteBatch>"));
}

TEST(CycloneDomainTest, BusesOfOneProcessShareADomainAndTheLastOneLeavesIt) {
  const BusConfig config = LoopbackConfig(Vendor::kCyclone);
  auto first = CycloneDomain::Join(config);
  ASSERT_TRUE(first) << first.error().message;
  BusConfig other = config;
  other.partition = "another";
  {
    const auto second = CycloneDomain::Join(other);
    ASSERT_TRUE(second) << second.error().message;
    EXPECT_EQ(*second, *first);
  }
  other.write_batching = true;
  const auto refused = CycloneDomain::Join(other);
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().code, ErrorCode::kInvalidArgument);
  EXPECT_EQ(refused.error().message,
            "bus.domain_id " + std::to_string(config.domain_id) +
                " is in use by this process with another network, peers or batching");
  (*first).reset();
  EXPECT_TRUE(CycloneDomain::Join(other)) << "the domain was left, so it can be joined anew";
}

TEST(CycloneDomainTest, AnInterfaceThatIsNotThereIsNamed) {
  BusConfig config = LoopbackConfig(Vendor::kCyclone);
  config.network = NetworkProfile::kInterfaces;
  config.interfaces = {"nosuch0"};
  const auto refused = CycloneDomain::Join(config);
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().code, ErrorCode::kUnavailable);
  EXPECT_TRUE(Contains(refused.error().message, "nosuch0")) << refused.error().message;
}

}  // namespace
}  // namespace limbcast::bus::cyclone
