#include "tools/limbcast/demo/free_domain.hpp"

#include <gtest/gtest.h>

namespace limbcast::tool {
namespace {

TEST(FreeDomainTest, ReadsPortsAsTheKernelWritesThem) {
  constexpr std::string_view kText =
      "  sl  local_address rem_address   st tx_queue rx_queue tr tm->when retrnsmt   uid\n"
      " 1234: 0100007F:1CE8 00000000:0000 07 00000000:00000000 00:00000000 00000000     0\n"
      "17: 00000000:0044 00000000:0000 07 00000000:00000000 00:00000000 00000000     0\n";
  EXPECT_EQ(ParseUdpPorts(kText), (std::vector<std::uint16_t>{7400, 68}));
  EXPECT_TRUE(ParseUdpPorts("").empty());
}

TEST(FreeDomainTest, PassesOverDomainsOfWhichAnyPortIsUsed) {
  // Domain 5: 8650 to 8899, domain 6: 8900 to 9149.
  EXPECT_EQ(*FindFreeDomain({8899, 8900}, 5), 7U);
  EXPECT_EQ(*FindFreeDomain({8649, 9150}, 5), 5U);
}

TEST(FreeDomainTest, StartsAtTheSeedAndWrapsAround) {
  EXPECT_EQ(*FindFreeDomain({}, 101), 101U);
  EXPECT_EQ(*FindFreeDomain({}, 102), 0U);
  EXPECT_EQ(*FindFreeDomain({32650}, 101), 0U);  // 32650 is the first port of domain 101
}

TEST(FreeDomainTest, SaysSoWhenThereIsNone) {
  std::vector<std::uint16_t> ports;
  for (std::uint16_t domain = 0; domain < 102; ++domain) {
    ports.push_back(static_cast<std::uint16_t>(7400 + 250 * domain));
  }
  const auto domain = FindFreeDomain(ports, 3);
  ASSERT_FALSE(domain.ok());
  EXPECT_EQ(domain.error().code, ErrorCode::kUnavailable);
}

}  // namespace
}  // namespace limbcast::tool
