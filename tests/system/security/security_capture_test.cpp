// What a sniffer reads on the network: in the clear everything, secured nothing.
#include <gmock/gmock.h>

#include <map>

#include "tests/support/topic_examples.hpp"
#include "tests/system/security/loopback_capture.hpp"
#include "tests/system/security/secure_peers.hpp"

namespace limbcast::security_test {
namespace {

using ::testing::HasSubstr;
using ::testing::StartsWith;
using namespace test_support;

constexpr std::uint32_t kKey = 7;

// 16 bytes of what travels for a value: enough to be there by intent only. Not out of its middle,
// where a library may cut a large one in two.
template <typename T>
std::string Piece(std::uint32_t sequence) {
  const std::string bytes = WireBytes(Example<T>(kKey, sequence));
  return bytes.substr(bytes.size() / 3, 16);
}

std::map<std::string, std::string> Secrets() {
  // As endpoints announce it, ended by a zero byte. In the permissions, which peers show each other
  // before they trust one another, the names of topics do stand: as <topic>NAME</topic>.
  return {{"name of a topic", std::string("limbcast/v1/skeleton") + '\0'},
          {"a skeleton", Piece<body::Skeleton>(1)},
          {"a segment", Piece<body::SegmentState>(1)},
          {"a sample", Piece<sensing::MargSample>(1)},
          {"who wears what", Example<roster::RosterEntry>(kKey, 1).person}};
}

class SecurityCaptureTest : public ::testing::TestWithParam<const char*> {
 protected:
  // Which of the secrets were on the wire while two peers exchanged everything.
  std::vector<std::string> Overheard(const std::string& folder) {
    const std::uint32_t domain = OwnDomain();
    auto capture = LoopbackCapture::Start(domain);
    EXPECT_TRUE(capture.ok());
    SecureBus one("one");
    SecureBus other("other");
    EXPECT_THAT(one.Open(GetParam(), domain, folder, kEverything, kKey), StartsWith("ok"));
    EXPECT_THAT(other.Open(GetParam(), domain, folder, kEverything, kKey + 1), StartsWith("ok"));
    (void)one.MakeEndpoints();
    (void)other.MakeEndpoints();
    const security::RoleGrant all = GrantOf(kEverything);
    const Counts expected = Expected(all, {all});
    EXPECT_TRUE(Eventually(kDeadline, [&] {
      return Difference(one.Now(), expected).empty() && Difference(other.Now(), expected).empty();
    }));
    one.Write();  // sequence 1, reliable
    EXPECT_TRUE(Eventually(kDeadline, [&] {
      const Counts heard = other.Now();
      return std::all_of(heard.begin(), heard.end(),
                         [](const auto& topic) { return topic.second.of_others > 0; });
    }));
    const auto& packets = (*capture)->Stop();
    EXPECT_GT(packets.size(), 50U);
    std::vector<std::string> overheard;
    for (const auto& [name, secret] : Secrets()) {
      for (const std::string& packet : packets) {
        if (packet.find(secret) != std::string::npos) {
          overheard.push_back(name);
          break;
        }
      }
    }
    return overheard;
  }
};

TEST_P(SecurityCaptureTest, NoPoseAndNoNameOfATopicCanBeReadOnASecuredNetwork) {
  if (const auto may = LoopbackCapture::Start(0); !may) {
    GTEST_SKIP() << "needs the right to sniff (CAP_NET_RAW): " << may.error().message;
  }
  for (const auto& [name, secret] : Secrets()) {
    EXPECT_GE(secret.size(), 12U) << name << ": as short a one may stand anywhere by chance";
  }
  const TemporaryFolder folder;
  MakeCredentials(folder / "ours");
  EXPECT_THAT(Overheard("-"), ::testing::SizeIs(Secrets().size()))
      << "or this test looks for the wrong bytes";
  EXPECT_THAT(Overheard(folder / "ours"), ::testing::IsEmpty());
}

INSTANTIATE_TEST_SUITE_P(Dds, SecurityCaptureTest, ::testing::Values("cyclone", "fast"),
                         [](const auto& test) { return std::string(test.param); });

// Every hop of the pipeline crosses from one library to the other.
TEST(SecurityDemoTest, APipelineOfBothLibrariesRunsSecured) {
  const TemporaryFolder folder;
  const Outcome created =
      RunToEnd({Program("limbcast"), "security", "create", folder / "credentials"});
  ASSERT_EQ(created.status, 0) << Describe(created);
  const DemoRun run =
      RunDemo({"--seconds", "5", "--dds", "mixed", "--security", folder / "credentials"},
              std::chrono::seconds(90));
  ASSERT_EQ(run.outcome.status, 0) << Describe(run.outcome);
  ASSERT_TRUE(run.summary.is_object());
  EXPECT_GT(run.summary.at("skeletons").get<std::uint64_t>(), 100U) << run.summary.dump(2);
  EXPECT_EQ(run.processes_left, 0U);
}

}  // namespace
}  // namespace limbcast::security_test
