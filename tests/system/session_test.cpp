// A session host as a process, its clients over the network, and what becomes of them when it is
// killed.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <signal.h>

#include <chrono>
#include <map>
#include <memory>
#include <mutex>
#include <string>
#include <utility>
#include <vector>

#include "common/bus/bus_factory.hpp"
#include "common/client/client.hpp"
#include "common/client/session_directory.hpp"
#include "common/sensing/coil_slots.hpp"
#include "tests/system/program.hpp"

namespace limbcast {
namespace {

using namespace std::chrono_literals;
using namespace test_support;
using ::testing::HasSubstr;

class SessionSystemTest : public ::testing::TestWithParam<const char*> {
 protected:
  process::ChildProcess StartHost() {
    auto host = process::ChildProcess::Start(
        {.arguments = {Program("limbcast-session"), "--dds", GetParam(), "--domain", domain_,
                       "--set", "session.state_dir=" + (folder_ / "state").string()}});
    EXPECT_TRUE(host.ok());
    return std::move(*host);
  }
  std::vector<std::string> Limbcast(std::vector<std::string> words) const {
    std::vector<std::string> arguments = {Program("limbcast"), "session"};
    arguments.insert(arguments.end(), words.begin(), words.end());
    for (const std::string& more :
         {std::string("--dds"), std::string(GetParam()), std::string("--domain"), domain_}) {
      arguments.push_back(more);
    }
    return arguments;
  }
  Outcome Run(const std::vector<std::string>& words) const {
    return RunToEnd(Limbcast(words), 20s);
  }
  client::ClientOptions As(roster::Role role, const std::string& person, std::uint64_t uid) const {
    client::ClientOptions options;
    options.dds = GetParam();
    options.domain_id = static_cast<std::uint32_t>(std::stoul(domain_));
    options.session = "stage";
    options.role = role;
    options.person = person;
    options.join_timeout = 20s;
    if (role == roster::Role::kPerformer) {
      options.sensors = {{.sensor_uid = {uid}, .segment = body::Segment::kHead}};
    }
    return options;
  }

  const std::string domain_ = std::to_string(OwnDomain());
  const TemporaryFolder folder_;
};

TEST_P(SessionSystemTest, AKilledHostReturnsAndNothingHasChanged) {
  auto host = StartHost();
  const Outcome created = Run({"create", "stage"});
  ASSERT_EQ(created.status, 0) << Describe(created) << host.Errors();
  const Outcome again = Run({"create", "stage"});
  EXPECT_EQ(again.status, 2) << Describe(again);
  EXPECT_THAT(again.errors, HasSubstr("already"));

  const auto ada = client::Client::Connect(As(roster::Role::kPerformer, "Ada", 11));
  ASSERT_TRUE(ada.ok()) << ada.error().message << host.Errors();
  const auto guest = client::Client::Connect(As(roster::Role::kSpectator, "guest", 0));
  ASSERT_TRUE(guest.ok()) << guest.error().message;
  ASSERT_TRUE(Eventually(10s, [&] { return (*guest)->Entry({1}).has_value(); }));
  EXPECT_EQ((*guest)->Entry({1})->person, "Ada");
  const auto before = (*guest)->Entry({1});

  host.Signal(SIGKILL);
  (void)host.Stop(5s);
  host = StartHost();
  const auto bob = client::Client::Connect(As(roster::Role::kPerformer, "Bob", 12));
  ASSERT_TRUE(bob.ok()) << bob.error().message << host.Errors();
  EXPECT_EQ((*bob)->Standing().body_id.value, 2U);
  ASSERT_TRUE(Eventually(10s, [&] { return (*bob)->Entry({1}).has_value(); }));
  EXPECT_EQ((*bob)->Entry({1}), before);
  EXPECT_EQ((*guest)->Entry({1}), before);
  EXPECT_TRUE((*ada)->Standing().member);

  const Outcome list = Run({"list"});
  EXPECT_EQ(list.status, 0) << Describe(list);
  EXPECT_THAT(list.output, HasSubstr("stage"));
  const Outcome sent_away = Run({"leave", "stage", "Bob"});
  EXPECT_EQ(sent_away.status, 0) << Describe(sent_away);
  const Outcome closed = Run({"close", "stage"});
  EXPECT_EQ(closed.status, 0) << Describe(closed);
  EXPECT_TRUE(Eventually(10s, [&] { return !(*ada)->Standing().member; }));
  EXPECT_TRUE(Eventually(10s, [&] { return !(*guest)->Entry({1}); }));
  const process::ExitState ended = host.Stop(8s);
  EXPECT_TRUE(ended.clean()) << ended.status << ' ' << ended.signal << host.Errors();
}

TEST_P(SessionSystemTest, PeopleOfTwoSessionsWithTheSameNamesDoNotMix) {
  auto host = StartHost();
  std::vector<process::ChildProcess> services;
  const auto start = [&](const std::string& program, const std::string& session,
                         std::vector<std::string> more) {
    std::vector<std::string> arguments = {Program(program), "--dds",       GetParam(), "--domain",
                                          domain_,          "--partition", session};
    arguments.insert(arguments.end(), more.begin(), more.end());
    auto started = process::ChildProcess::Start({.arguments = arguments});
    ASSERT_TRUE(started.ok());
    services.push_back(std::move(*started));
  };
  const auto start_gateway = [&](const std::string& session, const std::string& seed) {
    start("limbcast-gateway", session,
          {"--set", "gateway.session_host=true", "--set", "gateway.session=" + session, "--set",
           "gateway.person=Ada", "--set", "simulator.serial_prefix=sim" + seed});
  };
  std::map<std::string, std::unique_ptr<client::Client>> guests;
  for (const std::string session : {"stage", "studio"}) {
    ASSERT_EQ(Run({"create", session}).status, 0);
    start_gateway(session, session == "stage" ? "1" : "2");
    start("limbcast-fusion", session, {});
    start("limbcast-posture", session, {});
    client::ClientOptions options = As(roster::Role::kSpectator, "guest", 0);
    options.session = session;
    auto guest = client::Client::Connect(options);
    ASSERT_TRUE(guest.ok()) << guest.error().message;
    guests.emplace(session, std::move(*guest));
  }
  const auto moving_body = [&](const std::string& session) {
    const std::vector<BodyId> bodies = guests[session]->Bodies();
    return bodies.size() == 1 && guests[session]->Latest(bodies[0]) ? bodies[0] : BodyId{};
  };
  EXPECT_TRUE(Eventually(
      20s, [&] { return moving_body("stage").value != 0 && moving_body("studio").value != 0; }))
      << host.Errors() << services[0].Errors() << services[3].Errors();
  const BodyId stage = moving_body("stage");
  EXPECT_NE(stage, moving_body("studio"));
  EXPECT_EQ(guests["stage"]->Entry(stage)->person, "Ada");
  EXPECT_EQ(guests["studio"]->Entry(moving_body("studio"))->person, "Ada");

  // The gateway is killed and started again: the same person, the same body.
  services[0].Signal(SIGKILL);
  (void)services[0].Stop(5s);
  const auto before = guests["stage"]->Latest(stage)->measured_at;
  start_gateway("stage", "1");
  EXPECT_TRUE(Eventually(20s, [&] {
    return guests["stage"]->Latest(stage)->measured_at > before + 1s;
  })) << services.back().Errors();
  EXPECT_EQ(guests["stage"]->Bodies(), std::vector<BodyId>{stage});
  for (std::size_t i = 1; i < services.size(); ++i) {
    const process::ExitState ended = services[i].Stop(8s);
    EXPECT_TRUE(ended.clean()) << i << ": " << ended.status << ' ' << ended.signal;
  }
}

// Two gateways that know nothing of one another: the roster says when each one's coils are on.
TEST_P(SessionSystemTest, CoilsOfTwoGatewaysPulseInTheSlotsThatTheHostGrants) {
  auto host = StartHost();
  ASSERT_EQ(Run({"create", "stage"}).status, 0) << host.Errors();
  bus::BusConfig config;
  config.vendor = bus::ParseVendor(GetParam()).value();
  config.domain_id = static_cast<std::uint32_t>(std::stoul(domain_));
  config.partition = "stage";
  const auto bus = bus::Open(config).value();
  std::mutex mutex;
  std::map<SensorUid, std::uint32_t> bodies;             // who wears which sensor
  std::map<std::uint32_t, roster::RosterEntry> entries;  // by body
  std::map<std::uint32_t, std::vector<Time>> on_at;      // by body, whole pulses
  std::map<std::uint32_t, std::vector<Time>> off_at;
  const auto roster_reader = *bus->MakeReader<roster::RosterEntry>(
      {.on_sample =
           [&](const roster::RosterEntry& entry, const bus::SampleInfo&) {
             const std::scoped_lock lock(mutex);
             entries[entry.body_id.value] = entry;
             for (const roster::SensorAssignment& sensor : entry.sensors) {
               bodies[sensor.sensor_uid] = entry.body_id.value;
             }
           },
       .on_disposed = {}});
  const auto burst_reader = *bus->MakeReader<sensing::CoilBurst>(
      {.on_sample =
           [&](const sensing::CoilBurst& burst, const bus::SampleInfo&) {
             const std::scoped_lock lock(mutex);
             for (const sensing::CoilPulse& pulse : burst.pulses) {
               const auto body = bodies.find(burst.sensor_uid);
               if (pulse.off_at != Time{} && body != bodies.end()) {
                 on_at[body->second].push_back(pulse.on_at);
                 off_at[body->second].push_back(pulse.off_at);
               }
             }
           },
       .on_disposed = {}});
  std::vector<process::ChildProcess> gateways;
  for (const std::string person : {"Ada", "Bob"}) {
    auto started = process::ChildProcess::Start(
        {.arguments = {Program("limbcast-gateway"), "--dds", GetParam(), "--domain", domain_,
                       "--set", "gateway.session_host=true", "--set", "gateway.session=stage",
                       "--set", "gateway.person=" + person, "--set",
                       "simulator.serial_prefix=" + person, "--set",
                       "simulator.coils.source=pelvis"}});
    ASSERT_TRUE(started.ok());
    gateways.push_back(std::move(*started));
  }
  EXPECT_TRUE(Eventually(20s,
                         [&] {
                           const std::scoped_lock lock(mutex);
                           return on_at[1].size() > 20 && on_at[2].size() > 20;
                         }))
      << gateways[0].Errors() << gateways[1].Errors();
  for (process::ChildProcess& gateway : gateways) {
    EXPECT_TRUE(gateway.Stop(8s).clean());
  }
  const std::scoped_lock lock(mutex);
  EXPECT_NE(entries[1].coil_slot, entries[2].coil_slot);
  for (const std::uint32_t body : {1U, 2U}) {
    const roster::RosterEntry& entry = entries[body];
    EXPECT_EQ(entry.coil_slots, 2U);
    const sensing::CoilGrant grant{.slot = entry.coil_slot - 1,
                                   .slots = entry.coil_slots,
                                   .frame = std::chrono::microseconds(entry.coil_frame_us)};
    for (std::size_t i = 0; i < on_at[body].size(); ++i) {
      // Times of samples, one in 10 ms: the first with the coil on, the first without.
      EXPECT_TRUE(sensing::IsInSlot(grant, on_at[body][i])) << body;
      EXPECT_TRUE(sensing::IsInSlot(grant, off_at[body][i])) << body;
    }
  }
}

TEST_P(SessionSystemTest, WithoutAHostEveryCommandSaysSoInTime) {
  for (const std::vector<std::string>& words : {std::vector<std::string>{"list"},
                                                {"create", "stage"},
                                                {"join", "stage"},
                                                {"close", "stage"}}) {
    std::vector<std::string> timed = words;
    timed.insert(timed.end(), {"--timeout", "0.5"});
    const Outcome outcome = Run(timed);
    EXPECT_EQ(outcome.status, 1) << Describe(outcome);
    EXPECT_THAT(outcome.errors, HasSubstr("no session host"));
  }
}

INSTANTIATE_TEST_SUITE_P(Dds, SessionSystemTest, ::testing::Values("cyclone", "fast"),
                         [](const auto& test) { return std::string(test.param); });

}  // namespace
}  // namespace limbcast
