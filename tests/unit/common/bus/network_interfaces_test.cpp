#include "common/bus/network_interfaces.hpp"

#include <gtest/gtest.h>

#include <algorithm>

namespace limbcast::bus {
namespace {

const std::vector<NetworkInterface> kHost = {
    {.name = "lo", .address = "127.0.0.1", .up = true, .loopback = true},
    {.name = "eth0", .address = "10.0.0.5", .up = true, .multicast = true},
    {.name = "wlan0", .address = "10.1.0.5", .up = true, .multicast = true},
    {.name = "eth1", .address = "10.2.0.5"}};

BusConfig On(NetworkProfile network, std::vector<std::string> interfaces = {}) {
  return {.network = network, .interfaces = std::move(interfaces)};
}

TEST(NetworkInterfacesTest, ThisHostHasALoopback) {
  const auto host = HostInterfaces();
  EXPECT_TRUE(std::any_of(host.begin(), host.end(), [](const NetworkInterface& interface) {
    return interface.loopback && interface.up && interface.address == "127.0.0.1";
  }));
}

TEST(NetworkInterfacesTest, WhatIsUsedFollowsFromTheProfile) {
  const auto names = [](const BusConfig& config) {
    std::string text;
    for (const NetworkInterface& interface : UsedInterfaces(config, kHost)) {
      text += interface.name + ' ';
    }
    return text;
  };
  EXPECT_EQ(names(On(NetworkProfile::kLoopback)), "lo ");
  EXPECT_EQ(names(On(NetworkProfile::kLan)), "eth0 wlan0 ") << "eth1 is down";
  EXPECT_EQ(names(On(NetworkProfile::kWifi, {"wlan0"})), "wlan0 ");
  EXPECT_EQ(names(On(NetworkProfile::kInterfaces, {"10.2.0.5", "eth0"})), "eth0 eth1 ");
  EXPECT_EQ(names(On(NetworkProfile::kInterfaces, {"usb0"})), "");
}

TEST(NetworkInterfacesTest, DescribesInterfacesAndPeers) {
  EXPECT_EQ(DescribeNetwork(On(NetworkProfile::kLoopback), kHost), "loopback only");
  EXPECT_EQ(DescribeNetwork(On(NetworkProfile::kLan), kHost),
            "lan on one of eth0 10.0.0.5, wlan0 10.1.0.5, peers by multicast");
  BusConfig fast = On(NetworkProfile::kLan);
  fast.vendor = Vendor::kFast;
  EXPECT_EQ(DescribeNetwork(fast, kHost),
            "lan on eth0 10.0.0.5, wlan0 10.1.0.5, peers by multicast");
  BusConfig wifi = On(NetworkProfile::kWifi, {"wlan0"});
  wifi.peers = {"10.1.0.7", "studio"};
  EXPECT_EQ(DescribeNetwork(wifi, kHost), "wifi on wlan0 10.1.0.5, peers 10.1.0.7,studio");
  EXPECT_EQ(DescribeNetwork(On(NetworkProfile::kWifi, {"usb0"}), kHost),
            "wifi on no interface, peers by multicast");
}

}  // namespace
}  // namespace limbcast::bus
