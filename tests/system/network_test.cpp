// A network that refuses, and one on which nobody answers: said in one line, and nothing hangs.
#include <arpa/inet.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <signal.h>
#include <sys/socket.h>
#include <unistd.h>

#include <chrono>
#include <string>
#include <vector>

#include "tests/system/program.hpp"

namespace limbcast {
namespace {

using namespace std::chrono_literals;
using namespace test_support;
using ::testing::HasSubstr;

// Holds every unicast port that a participant of `domain` could take.
class OccupiedDomain {
 public:
  explicit OccupiedDomain(std::uint32_t domain) {
    for (std::uint32_t offset = 0; offset < 250; ++offset) {
      const int fd = socket(AF_INET, SOCK_DGRAM, 0);
      sockaddr_in address{};
      address.sin_family = AF_INET;
      address.sin_addr.s_addr = htonl(INADDR_ANY);
      address.sin_port = htons(static_cast<std::uint16_t>(7400 + 250 * domain + offset));
      // NOLINTNEXTLINE(*-reinterpret-cast): the interface of bind
      if (bind(fd, reinterpret_cast<const sockaddr*>(&address), sizeof address) == 0) {
        fds_.push_back(fd);
      } else {
        close(fd);
      }
    }
  }
  ~OccupiedDomain() {
    for (const int fd : fds_) {
      close(fd);
    }
  }
  OccupiedDomain(const OccupiedDomain&) = delete;
  OccupiedDomain& operator=(const OccupiedDomain&) = delete;
  [[nodiscard]] std::size_t ports() const { return fds_.size(); }

 private:
  std::vector<int> fds_;
};

class NetworkTest : public ::testing::TestWithParam<const char*> {};

TEST_P(NetworkTest, DomainWithoutAFreePortIsRefusedWithItsNumber) {
  const std::uint32_t domain = OwnDomain();
  const OccupiedDomain occupied(domain);
  ASSERT_EQ(occupied.ports(), 250U);
  for (const char* program : {"limbcast-gateway", "limbcast-fusion", "limbcast-posture"}) {
    const Outcome outcome = RunToEnd({Program(program), "--dds", GetParam(), "--domain",
                                      std::to_string(domain), "--log-level", "error"});
    SCOPED_TRACE(Describe(outcome));
    EXPECT_FALSE(outcome.timed_out);
    EXPECT_EQ(outcome.status, 1);
    EXPECT_EQ(std::count(outcome.errors.begin(), outcome.errors.end(), '\n'), 1);
    EXPECT_THAT(outcome.errors, HasSubstr("domain " + std::to_string(domain)));
  }
}

TEST_P(NetworkTest, AServiceWithoutPeersRunsAndEndsWhenAsked) {
  for (const char* program : {"limbcast-gateway", "limbcast-fusion", "limbcast-posture"}) {
    SCOPED_TRACE(program);
    const std::string domain = std::to_string(OwnDomain());
    auto service = process::ChildProcess::Start(
        {.arguments = {Program(program), "--dds", GetParam(), "--domain", domain}});
    ASSERT_TRUE(service.ok());
    const Outcome health = RunToEnd({Program("limbcast"), "echo", "health", "--dds", GetParam(),
                                     "--domain", domain, "--count", "1", "--timeout", "8"});
    EXPECT_EQ(health.status, 0) << Describe(health) << service->Errors();
    const process::ExitState ended = service->Stop(8s);
    EXPECT_TRUE(ended.clean()) << ended.status << ' ' << ended.signal << service->Errors();
  }
}

TEST_P(NetworkTest, AGatewayThatWaitsInVainSaysForWhom) {
  const std::string domain = std::to_string(OwnDomain());
  const Outcome outcome =
      RunToEnd({Program("limbcast-gateway"), "--dds", GetParam(), "--domain", domain, "--set",
                "gateway.wait_for=posture", "--set", "gateway.wait_timeout_s=0.5", "--set",
                "gateway.wait_timeout_action=exit"});
  EXPECT_FALSE(outcome.timed_out);
  EXPECT_EQ(outcome.status, 1) << Describe(outcome);
  EXPECT_THAT(outcome.errors, HasSubstr("0.5 s"));
}

TEST_P(NetworkTest, AListenerWithoutPeersEndsInTime) {
  const std::string domain = std::to_string(OwnDomain());
  const Outcome outcome = RunToEnd({Program("limbcast"), "echo", "skeleton", "--dds", GetParam(),
                                    "--domain", domain, "--count", "1", "--timeout", "1"});
  EXPECT_EQ(outcome.status, 1) << Describe(outcome);
  EXPECT_THAT(outcome.errors, HasSubstr("skeleton: 0 samples in 1 s"));
  const Outcome top = RunToEnd({Program("limbcast"), "top", "--once", "--interval", "0.2", "--dds",
                                GetParam(), "--domain", domain});
  EXPECT_EQ(top.status, 0) << Describe(top);
  EXPECT_THAT(top.output, HasSubstr("nobody reports here"));
}

INSTANTIATE_TEST_SUITE_P(Dds, NetworkTest, ::testing::Values("cyclone", "fast"),
                         [](const auto& test) { return std::string(test.param); });

}  // namespace
}  // namespace limbcast
