#include "tools/limbcast/doctor/peer_probe.hpp"

#include <arpa/inet.h>
#include <gtest/gtest.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <unistd.h>

#include <fstream>
#include <iterator>

#include "tools/limbcast/demo/free_domain.hpp"

namespace limbcast::tool {
namespace {

using namespace std::chrono_literals;

class PeerProbeTest : public ::testing::Test {
 protected:
  PeerProbeTest() : domain_(FindFreeDomain().value()) {}
  const std::uint32_t domain_;
};

TEST_F(PeerProbeTest, AHostOnWhichNobodyListensSaysSo) {
  const PeerProbe probe = ProbePeer("127.0.0.1", domain_, 5s);
  EXPECT_EQ(probe.address, "127.0.0.1");
  EXPECT_EQ(probe.leaves_by, "127.0.0.1");
  EXPECT_EQ(probe.refused, 8U);
  EXPECT_EQ(probe.silent + probe.blocked, 0U);
}

TEST_F(PeerProbeTest, APortOnWhichSomebodyListensIsSilent) {
  const int fd = socket(AF_INET, SOCK_DGRAM, 0);
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  address.sin_port = htons(static_cast<std::uint16_t>(7410 + 250 * domain_));
  ASSERT_EQ(bind(fd, reinterpret_cast<const sockaddr*>(&address), sizeof address), 0);  // NOLINT
  const PeerProbe probe = ProbePeer("127.0.0.1", domain_, 100ms);
  EXPECT_EQ(probe.silent, 1U);
  EXPECT_EQ(probe.refused, 7U);
  close(fd);
}

TEST_F(PeerProbeTest, ANameThatNobodyKnowsHasNoAddress) {
  const PeerProbe probe = ProbePeer("no.such.host.invalid", domain_, 1s);
  EXPECT_EQ(probe.address, "");
  EXPECT_EQ(probe.refused + probe.silent + probe.blocked, 0U);
}

}  // namespace
}  // namespace limbcast::tool
