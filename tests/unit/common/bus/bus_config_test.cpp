#include "common/bus/bus_config.hpp"

#include <gtest/gtest.h>

namespace limbcast::bus {
namespace {

using std::chrono::milliseconds;
using std::chrono::seconds;

std::string Refusal(const BusConfig& config) {
  const Status status = Validate(config);
  return status.ok() ? "" : status.error().message;
}

TEST(BusConfigTest, DefaultsAndLimitsAreValid) {
  EXPECT_EQ(Refusal({}), "");
  EXPECT_EQ(Refusal({.domain_id = 0}), "");
  EXPECT_EQ(Refusal({.domain_id = 101}), "");
  EXPECT_EQ(Refusal({.ownership_strength = 0, .stream_lease = milliseconds(50)}), "");
  EXPECT_EQ(Refusal({.ownership_strength = 1000, .stream_lease = seconds(60)}), "");
  EXPECT_EQ(Refusal({.stream_depth = 1}), "");
  EXPECT_EQ(Refusal({.stream_depth = 1024}), "");
  EXPECT_EQ(Refusal({.peers = {"10.0.0.1", "host-2.lan", "fe80::1%eth0"}}), "");
}

TEST(BusConfigTest, WhatIsOutOfRangeIsNamedWithItsLimit) {
  EXPECT_EQ(Refusal({.domain_id = 102}), "bus.domain_id must be in [0, 101], is 102");
  EXPECT_EQ(Refusal({.ownership_strength = -1}),
            "bus.ownership_strength must be in [0, 1000], is -1");
  EXPECT_EQ(Refusal({.ownership_strength = 1001}),
            "bus.ownership_strength must be in [0, 1000], is 1001");
  EXPECT_EQ(Refusal({.stream_lease = milliseconds(49)}),
            "bus.stream_lease_s must be in [0.05, 60], is 0.049000");
  EXPECT_EQ(Refusal({.stream_lease = seconds(61)}),
            "bus.stream_lease_s must be in [0.05, 60], is 61.000000");
  EXPECT_EQ(Refusal({.send_loss_permille = 500}), "");
  EXPECT_EQ(Refusal({.send_loss_permille = 501}),
            "bus.send_loss_permille must be in [0, 500], is 501");
  EXPECT_EQ(Refusal({.stream_depth = 0}), "bus.stream_depth must be in [1, 1024], is 0");
  EXPECT_EQ(Refusal({.stream_depth = 1025}), "bus.stream_depth must be in [1, 1024], is 1025");
  EXPECT_EQ(Refusal({.partition = std::string(65, 'p')}),
            "bus.partition must be at most 64 characters, is 65 long");
  EXPECT_EQ(Refusal({.partition = "a,b"}),
            "bus.partition must be one name without commas, is \"a,b\"");
  EXPECT_EQ(Refusal({.participant_name = std::string(65, 'p')}),
            "bus.participant_name must be at most 64 characters, is 65 long");
  EXPECT_EQ(Refusal({.network = NetworkProfile::kInterfaces}),
            "bus.network must be loopback, lan, wifi or names of interfaces, is \"\"");
}

TEST(BusConfigTest, TextThatWouldBreakOutOfTheMiddlewaresConfigurationIsRefused) {
  EXPECT_EQ(Refusal({.peers = {"1.2.3.4\"/><x"}}),
            "bus.peers must be names or addresses of hosts, is \"1.2.3.4\"/><x\"");
  EXPECT_EQ(Refusal({.network = NetworkProfile::kInterfaces, .interfaces = {"eth0 "}}),
            "bus.network must be names or addresses of interfaces, is \"eth0 \"");
}

TEST(BusConfigTest, VendorsAreParsedByName) {
  EXPECT_EQ(ParseVendor("cyclone").value(), Vendor::kCyclone);
  EXPECT_EQ(ParseVendor("fast").value(), Vendor::kFast);
  EXPECT_EQ(ParseVendor("inproc").value(), Vendor::kInproc);
  const auto refused = ParseVendor("Fast");
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().message, "bus.dds must be one of cyclone, fast, inproc, is \"Fast\"");
}

TEST(BusConfigTest, NetworksAreParsedByNameOrList) {
  BusConfig config;
  ASSERT_TRUE(ParseNetwork("eth0, 10.0.0.7", config));
  EXPECT_EQ(config.network, NetworkProfile::kInterfaces);
  EXPECT_EQ(config.interfaces, (std::vector<std::string>{"eth0", "10.0.0.7"}));
  ASSERT_TRUE(ParseNetwork("lan", config));
  EXPECT_EQ(config.network, NetworkProfile::kLan);
  EXPECT_TRUE(config.interfaces.empty());
  ASSERT_TRUE(ParseNetwork("wifi", config));
  EXPECT_EQ(config.network, NetworkProfile::kWifi);
  ASSERT_TRUE(ParseNetwork("wifi:wlan0", config));
  EXPECT_EQ(config.network, NetworkProfile::kWifi);
  EXPECT_EQ(config.interfaces, std::vector<std::string>{"wlan0"});
  ASSERT_TRUE(ParseNetwork("lan:eth0,eth1", config));
  EXPECT_EQ(config.network, NetworkProfile::kInterfaces);
  EXPECT_EQ(config.interfaces, (std::vector<std::string>{"eth0", "eth1"}));
  ASSERT_TRUE(ParseNetwork("loopback", config));
  EXPECT_EQ(config.network, NetworkProfile::kLoopback);
}

TEST(BusConfigTest, AListWithAHoleIsRefusedAndChangesNothing) {
  BusConfig config;
  for (const char* text : {"", "eth0,", ",eth0", "eth 0", "wifi:", "lan:,"}) {
    const Status parsed = ParseNetwork(text, config);
    ASSERT_FALSE(parsed) << text;
    EXPECT_EQ(parsed.error().message,
              "bus.network must be loopback, lan, wifi or names of interfaces, is \"" +
                  std::string(text) + '"');
  }
  EXPECT_EQ(config.network, NetworkProfile::kLoopback);
  EXPECT_TRUE(config.interfaces.empty());
}

}  // namespace
}  // namespace limbcast::bus
