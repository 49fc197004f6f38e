// `limbcast doctor` on real networks with something wrong: the finding is there, and with it what
// to do. What cannot be made here without breaking the host is in tests/unit/tools/limbcast/doctor.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <chrono>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "common/bus/bus_factory.hpp"
#include "common/bus/system_now.hpp"
#include "tests/system/network/network_hosts.hpp"
#include "tests/system/program.hpp"

namespace limbcast {
namespace {

using namespace std::chrono_literals;
using namespace test_support;
using ::testing::AllOf;
using ::testing::Contains;
using ::testing::HasSubstr;
using ::testing::Not;

class DoctorTest : public ::testing::TestWithParam<const char*> {
 protected:
  process::ChildProcess Start(const std::string& program, std::vector<std::string> more = {}) {
    std::vector<std::string> arguments = {Program(program), "--dds", GetParam(), "--domain",
                                          domain_};
    arguments.insert(arguments.end(), more.begin(), more.end());
    auto started = process::ChildProcess::Start({.arguments = arguments});
    EXPECT_TRUE(started.ok());
    return std::move(*started);
  }
  std::vector<std::string> DoctorLine(std::vector<std::string> more = {}) const {
    std::vector<std::string> arguments = {Program("limbcast"), "doctor",   "--json", "--dds",
                                          GetParam(),          "--domain", domain_};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return arguments;
  }
  // Ids of the findings, each with its text.
  static std::vector<std::string> Findings(const std::vector<std::string>& line) {
    const Outcome outcome = RunToEnd(line, 60s);
    const auto json = nlohmann::json::parse(outcome.output, nullptr, false);
    EXPECT_TRUE(json.is_object()) << Describe(outcome);
    std::vector<std::string> findings;
    if (json.is_object()) {
      for (const auto& finding : json.at("findings")) {
        findings.push_back(finding.at("id").get<std::string>() + ": " +
                           finding.at("text").get<std::string>());
        EXPECT_NE(finding.at("advice").get<std::string>(), "");
      }
      EXPECT_EQ(outcome.status, findings.empty() ? 0 : 1);
    }
    return findings;
  }
  // The same until `wanted` is among them: on a busy host a peer may need longer than one look.
  template <typename Matcher>
  void ExpectFinding(const std::vector<std::string>& line, const Matcher& wanted) {
    std::vector<std::string> findings;
    EXPECT_TRUE(Eventually(60s, [&] {
      findings = Findings(line);
      return ::testing::Value(findings, Contains(wanted));
    })) << ::testing::PrintToString(findings);
  }

  const std::string domain_ = std::to_string(OwnDomain());
};

TEST_P(DoctorTest, NobodyThere) {
  const auto findings = Findings(DoctorLine({"--seconds", "1"}));
  EXPECT_THAT(findings, Contains(HasSubstr("no_peers: nobody answered in domain " + domain_)));
}

TEST_P(DoctorTest, AnInterfaceThatDoesNotExist) {
  EXPECT_THAT(Findings(DoctorLine({"--network", "nosuch0"})),
              Contains(HasSubstr("wrong_interface: interface nosuch0 does not exist")));
}

TEST_P(DoctorTest, ANetworkOfLeasesThatDoNotFit) {
  auto posture = Start("limbcast-posture", {"--set", "bus.stream_lease_s=5"});
  ExpectFinding(DoctorLine(), AllOf(HasSubstr("qos_mismatch"), HasSubstr("skeleton")));
  (void)posture.Stop(8s);
}

TEST_P(DoctorTest, TwoSessionHosts) {
  auto one = Start("limbcast-session");
  auto other = Start("limbcast-session");
  ExpectFinding(DoctorLine(), HasSubstr("two_session_hosts: 2 session hosts"));
  (void)one.Stop(8s);
  (void)other.Stop(8s);
}

TEST_P(DoctorTest, TwoGatewaysWithTheSameSensors) {
  auto one = Start("limbcast-gateway");
  auto other = Start("limbcast-gateway");
  ExpectFinding(DoctorLine(), HasSubstr("duplicate_sensor"));
  (void)one.Stop(8s);
  (void)other.Stop(8s);
}

TEST_P(DoctorTest, AClockThatIsAhead) {
  bus::BusConfig config;
  config.vendor = bus::ParseVendor(GetParam()).value();
  config.domain_id = static_cast<std::uint32_t>(std::stoul(domain_));
  const auto bus = bus::Open(config);
  ASSERT_TRUE(bus.ok());
  const auto writer = (*bus)->MakeWriter<ServiceHealth>();
  ASSERT_TRUE(writer.ok());
  auto doctor = process::ChildProcess::Start({.arguments = DoctorLine({"--seconds", "3"})});
  ASSERT_TRUE(doctor.ok());
  // Reports like a service whose clock is three seconds ahead, for as long as the doctor looks.
  ServiceHealth health;
  health.process_uid = 77;
  health.role = "fusion";
  health.host = "studio";
  const auto ended = [&] {
    health.reported_at = bus::SystemNow() + 3s;
    EXPECT_TRUE((*writer)->Write(health).ok());
    return doctor->Wait(100ms).has_value();
  };
  EXPECT_TRUE(Eventually(60s, ended));
  const std::string output = doctor->Output();
  EXPECT_THAT(output, AllOf(HasSubstr("clock_offset"), HasSubstr("ahead of ours")));
  EXPECT_THAT(output, HasSubstr("the clock of studio is about"));
}

TEST_P(DoctorTest, AHealthyPipelineHasNoFindingOfTheNetwork) {
  auto gateway = Start("limbcast-gateway");
  auto fusion = Start("limbcast-fusion");
  std::vector<std::string> findings;
  EXPECT_TRUE(Eventually(60s, [&] {
    findings = Findings(DoctorLine());
    // What this host has lying around is not about this network.
    std::erase_if(findings, [](const std::string& finding) {
      return finding.starts_with("stale_shared_memory") ||
             finding.starts_with("small_socket_buffers") || finding.starts_with("clock_offset");
    });
    return findings.empty();
  })) << ::testing::PrintToString(findings);
  (void)gateway.Stop(8s);
  (void)fusion.Stop(8s);
}

TEST_P(DoctorTest, AHostThatCannotBeReachedOrHasNobodyOnIt) {
  auto hosts = NetworkHosts::Make(2);
  if (!hosts) {
    GTEST_SKIP() << "needs the right to make network namespaces: " << hosts.error().message;
  }
  const std::string peer = NetworkHosts::AddressOf(1);
  const std::vector<std::string> line =
      (*hosts)->On(0, DoctorLine({"--network", "wifi:eth0", "--peer", peer, "--seconds", "1"}));
  EXPECT_THAT(Findings(line), Contains(HasSubstr("no_peers")))
      << "the host answers, nobody is there";
  const std::vector<std::string> elsewhere =
      (*hosts)->On(0, DoctorLine({"--peer", peer, "--seconds", "1"}));
  EXPECT_THAT(Findings(elsewhere),
              Contains(AllOf(HasSubstr("wrong_interface"), HasSubstr("leaves by 10.77.0.1"))));
  (*hosts)->Connect(1, false);
  EXPECT_THAT(Findings(line), Contains(HasSubstr("blocked_ports: ")));
}

INSTANTIATE_TEST_SUITE_P(Dds, DoctorTest, ::testing::Values("cyclone", "fast"),
                         [](const auto& test) { return std::string(test.param); });

}  // namespace
}  // namespace limbcast
