#include "tools/limbcast/doctor/announcements.hpp"

#include <arpa/inet.h>
#include <gtest/gtest.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <unistd.h>

#include "tools/limbcast/demo/free_domain.hpp"

namespace limbcast::tool {
namespace {

std::string Message(char vendor_high, char vendor_low) {
  std::string message = "RTPS";
  message += {2, 2, vendor_high, vendor_low};
  message.resize(20);
  return message;
}

TEST(AnnouncementsTest, LibrariesAreKnownByTheirVendorId) {
  EXPECT_EQ(LibraryOf(Message(1, 0x0F)), "Fast DDS");
  EXPECT_EQ(LibraryOf(Message(1, 0x10)), "Cyclone DDS");
  EXPECT_EQ(LibraryOf(Message(1, 0x01)), "vendor 0101");
}

TEST(AnnouncementsTest, OtherPacketsAreNone) {
  EXPECT_EQ(LibraryOf(""), std::nullopt);
  EXPECT_EQ(LibraryOf("RTPS"), std::nullopt);
  EXPECT_EQ(LibraryOf(std::string(40, 'x')), std::nullopt);
}

// Sent to the group by its multicast address over the loopback, as the kernel gives it to members.
TEST(AnnouncementsTest, WhatComesToTheGroupIsHeardOnce) {
  const std::uint32_t domain = FindFreeDomain().value();
  AnnouncementListener listener(
      domain, {{.name = "lo", .address = "127.0.0.1", .up = true, .loopback = true}});
  const int fd = socket(AF_INET, SOCK_DGRAM, 0);
  in_addr loopback{htonl(INADDR_LOOPBACK)};
  setsockopt(fd, IPPROTO_IP, IP_MULTICAST_IF, &loopback, sizeof loopback);
  sockaddr_in group{};
  group.sin_family = AF_INET;
  group.sin_port = htons(static_cast<std::uint16_t>(7400 + 250 * domain));
  inet_pton(AF_INET, "239.255.0.1", &group.sin_addr);
  const std::string message = Message(1, 0x10);
  for (int i = 0; i < 2; ++i) {
    const ssize_t sent = sendto(fd, message.data(), message.size(), 0,
                                reinterpret_cast<const sockaddr*>(&group),  // NOLINT: of sendto
                                sizeof group);
    if (sent < 0) {
      close(fd);
      GTEST_SKIP() << "this host sends no multicast on its loopback";
    }
  }
  close(fd);
  // On the loopback a packet is there when sendto returns.
  EXPECT_EQ(listener.Heard(), (std::vector<Announcement>{{"127.0.0.1", "Cyclone DDS"}}));
}

}  // namespace
}  // namespace limbcast::tool
