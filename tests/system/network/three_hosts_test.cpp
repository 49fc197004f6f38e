// Three hosts on a network, four people in one session: a late spectator, a cable that is pulled
// for five seconds, and every service killed in turn. Nobody is lost and nobody has to calibrate
// again.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <signal.h>

#include <chrono>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "common/client/client.hpp"
#include "tests/system/network/network_hosts.hpp"
#include "tests/system/program.hpp"

namespace limbcast {
namespace {

using namespace std::chrono_literals;
using namespace test_support;

constexpr std::size_t kStage = 0;   // gateway of two people, session host
constexpr std::size_t kHall = 1;    // gateway of two people, fusion
constexpr std::size_t kStudio = 2;  // posture, clients
constexpr std::size_t kPeople = 4;
constexpr auto kDeadline = 30s;  // however long a busy machine may take

struct Libraries {
  const char* name;
  const char* stage;
  const char* hall;
  const char* studio;
};

class ThreeHostsTest : public ::testing::TestWithParam<Libraries> {
 protected:
  void SetUp() override {
    auto hosts = NetworkHosts::Make(3);
    if (!hosts) {
      GTEST_SKIP() << "needs the right to make network namespaces: " << hosts.error().message;
    }
    hosts_ = std::move(*hosts);
  }

  static const char* LibraryOf(std::size_t host) {
    return host == kStage ? GetParam().stage
                          : (host == kHall ? GetParam().hall : GetParam().studio);
  }
  void Start(const std::string& name, std::size_t host, const std::string& program,
             const std::vector<std::string>& more) {
    std::vector<std::string> arguments = {
        Program(program), "--dds", LibraryOf(host), "--domain", "3",
        "--network",      "lan",   "--log-level",   "warning"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    auto started = process::ChildProcess::Start({.arguments = hosts_->On(host, arguments)});
    ASSERT_TRUE(started.ok()) << started.error().message;
    services_.insert_or_assign(name, std::move(*started));
  }
  void Start(const std::string& name) {
    if (name == "session") {
      Start(name, kStage, "limbcast-session",
            {"--set", "session.sessions=[\"stage\"]", "--set",
             "session.state_dir=" + (folder_ / "session").string()});
    } else if (name == "fusion") {
      Start(name, kHall, "limbcast-fusion", {"--partition", "stage"});
    } else if (name == "posture") {
      Start(
          name, kStudio, "limbcast-posture",
          {"--partition", "stage", "--set", "posture.state_dir=" + (folder_ / "posture").string()});
    } else {
      Start(name, name == "Ada" ? kStage : kHall, "limbcast-gateway",
            {"--set", "gateway.session_host=true", "--set", "gateway.session=stage", "--set",
             "gateway.person=" + name, "--set", "simulator.persons=2", "--set",
             "simulator.motion=standing", "--set", "simulator.sensors=reduced15", "--set",
             "simulator.serial_prefix=" + name});
    }
  }
  void KillAndRestart(const std::string& name) {
    services_.at(name).Signal(SIGKILL);
    (void)services_.at(name).Stop(5s);
    Start(name);
  }

  std::unique_ptr<client::Client> Join(roster::Role role, const std::string& person) {
    client::ClientOptions options;
    options.dds = LibraryOf(kStudio);
    options.domain_id = 3;
    options.network = "lan";
    options.session = "stage";
    options.role = role;
    options.person = person;
    options.join_timeout = kDeadline;
    std::unique_ptr<client::Client> client;
    hosts_->RunOn(kStudio, [&] {
      auto connected = client::Client::Connect(options);
      EXPECT_TRUE(connected.ok()) << connected.error().message << Errors();
      if (connected.ok()) {
        client = std::move(*connected);
      }
    });
    return client;
  }

  // When each of the people was last seen.
  static std::map<BodyId, Time> Seen(const client::Client& client) {
    std::map<BodyId, Time> seen;
    for (const BodyId body : client.Bodies()) {
      if (const auto skeleton = client.Latest(body)) {
        seen[body] = skeleton->measured_at;
      }
    }
    return seen;
  }
  // Waits until all of them have moved on since `after`, and says how long that took.
  static Duration WaitForAll(const client::Client& client, Time after) {
    const auto begin = std::chrono::steady_clock::now();
    EXPECT_TRUE(Eventually(kDeadline, [&] {
      const auto seen = Seen(client);
      return seen.size() == kPeople && std::all_of(seen.begin(), seen.end(), [&](const auto& one) {
               return one.second > after;
             });
    }));
    return std::chrono::steady_clock::now() - begin;
  }
  [[nodiscard]] std::string Errors() const {
    std::string text;
    for (const auto& [name, service] : services_) {
      text += "\n" + name + ":\n" + service.Errors();
    }
    return text;
  }

  const TemporaryFolder folder_;
  std::unique_ptr<NetworkHosts> hosts_;
  std::map<std::string, process::ChildProcess> services_;
};

// Who is who, and how their sensors sit: what must survive everything.
std::map<std::string, std::string> Identities(const client::Client& client) {
  std::map<std::string, std::string> identities;
  for (const BodyId body : client.Bodies()) {
    const auto entry = client.Entry(body);
    const auto definition = client.Definition(body);
    std::string text = "body " + std::to_string(body.value);
    for (const body::SegmentDefinition& segment : definition->segments) {
      if (segment.tracked) {
        const auto& q = segment.q_sensor_segment;
        text += " " + std::to_string(segment.sensor_uid.value) + (segment.aligned ? "+" : "-") +
                std::to_string(static_cast<int>(std::abs(q.w()) * 1000.0)) + "/" +
                std::to_string(static_cast<int>(std::abs(q.z()) * 1000.0));
      }
    }
    identities[entry ? entry->person : "?"] = text;
  }
  return identities;
}

TEST_P(ThreeHostsTest, FourPeopleSurvivePulledCablesAndKilledServices) {
  for (const char* name : {"session", "fusion", "posture", "Ada", "Bob"}) {
    Start(name);
  }
  const auto operator_client = Join(roster::Role::kOperator, "operator");
  ASSERT_NE(operator_client, nullptr);
  WaitForAll(*operator_client, Time{});
  ASSERT_EQ(operator_client->Bodies().size(), kPeople) << Errors();
  for (const BodyId body : operator_client->Bodies()) {
    EXPECT_TRUE(Eventually(kDeadline,
                           [&] {
                             const auto reply =
                                 operator_client->Send(roster::CommandKind::kReferencePose, body);
                             return reply.ok() && reply->accepted;
                           }))
        << body.value << Errors();
  }
  const auto all_aligned = [](const client::Client& client) {
    const auto identities = Identities(client);
    return identities.size() == kPeople &&
           std::all_of(identities.begin(), identities.end(),
                       [](const auto& one) { return one.second.find('-') == std::string::npos; });
  };
  ASSERT_TRUE(Eventually(kDeadline, [&] { return all_aligned(*operator_client); })) << Errors();

  // Late, and knows everybody at once.
  const auto spectator = Join(roster::Role::kSpectator, "late");
  ASSERT_NE(spectator, nullptr);
  ASSERT_TRUE(Eventually(kDeadline, [&] { return all_aligned(*spectator); }));
  WaitForAll(*spectator, Time{});
  const auto identities = Identities(*spectator);
  EXPECT_EQ(identities, Identities(*operator_client));

  hosts_->Connect(kHall, false);
  const Time cut_at = spectator->Now();
  ASSERT_FALSE(Eventually(5s, [] { return false; })) << "the cable is out for five seconds";
  hosts_->Connect(kHall, true);
  const Duration resumed = WaitForAll(*spectator, cut_at + 5s);
  RecordProperty("resumed_after_cable_ms", std::to_string(ToSeconds(resumed) * 1e3));
  EXPECT_EQ(Identities(*spectator), identities) << Errors();

  for (const char* name : {"session", "fusion", "posture", "Ada", "Bob"}) {
    SCOPED_TRACE(name);
    KillAndRestart(name);
    const Duration back = WaitForAll(*spectator, spectator->Now());
    RecordProperty(std::string("resumed_after_") + name + "_ms",
                   std::to_string(ToSeconds(back) * 1e3));
    EXPECT_TRUE(Eventually(kDeadline, [&] { return Identities(*spectator) == identities; }))
        << ::testing::PrintToString(Identities(*spectator)) << Errors();
  }
  for (auto& [name, service] : services_) {
    const process::ExitState ended = service.Stop(8s);
    EXPECT_TRUE(ended.clean()) << name << ", status " << ended.status << ", signal " << ended.signal
                               << ": " << service.Errors();
  }
}

INSTANTIATE_TEST_SUITE_P(Dds, ThreeHostsTest,
                         ::testing::Values(Libraries{"cyclone", "cyclone", "cyclone", "cyclone"},
                                           Libraries{"fast", "fast", "fast", "fast"},
                                           Libraries{"mixed", "cyclone", "fast", "cyclone"}),
                         [](const auto& test) { return std::string(test.param.name); });

}  // namespace
}  // namespace limbcast
