#include "services/session/session_service.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>
#include <map>
#include <optional>

#include "tests/support/fake_clock.hpp"
#include "tests/support/immediate_pool.hpp"
#include "tests/support/temporary_folder.hpp"
#include "tests/unit/services/session/registry_rig.hpp"

namespace limbcast::session {
namespace {

using namespace std::chrono_literals;
using roster::CommandKind;
using roster::Role;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::Pair;
using ::testing::UnorderedElementsAre;

// Somebody on the network, in one partition.
class Peer {
 public:
  Peer(const std::shared_ptr<bus::inproc::Hub>& hub, const std::string& partition)
      : bus_(InPartition(hub, partition)),
        requests_(*bus_->MakeWriter<roster::JoinRequest>()),
        commands_(*bus_->MakeWriter<roster::Command>()) {
    replies_ = *bus_->MakeReader<roster::JoinReply>(
        {.on_sample = [this](const auto& reply, const bus::SampleInfo&) { joined = reply; },
         .on_disposed = {}});
    command_replies_ = *bus_->MakeReader<roster::CommandReply>(
        {.on_sample = [this](const auto& reply, const bus::SampleInfo&) { done = reply; },
         .on_disposed = {}});
    entries_ = *bus_->MakeReader<roster::RosterEntry>(
        {.on_sample =
             [this](const auto& entry, const bus::SampleInfo&) {
               ++heard;
               roster[entry.body_id.value] = entry;
             },
         .on_disposed = [this](const auto& key) { roster.erase(key.body_id.value); }});
    states_ = *bus_->MakeReader<roster::SessionState>(
        {.on_sample =
             [this](const auto& state, const bus::SampleInfo&) {
               sessions[state.name] = state.performer_count;
               names_[state.session_id] = state.name;
             },
         .on_disposed = [this](const auto& key) { sessions.erase(names_[key.session_id]); }});
  }
  roster::JoinReply Join(const roster::JoinRequest& request) {
    joined.reset();
    EXPECT_TRUE(requests_->Write(request).ok());
    roster::JoinReply none;
    none.message = "no answer";
    return joined.value_or(none);
  }
  roster::CommandReply Ask(roster::Command command) {
    command.request_id = ++asked_;
    return Repeat(command);
  }
  roster::CommandReply Repeat(const roster::Command& command) {
    done.reset();
    EXPECT_TRUE(commands_->Write(command).ok());
    roster::CommandReply none;
    none.message = "no answer";
    return done.value_or(none);
  }

  std::optional<roster::JoinReply> joined;
  std::optional<roster::CommandReply> done;
  std::map<std::uint32_t, roster::RosterEntry> roster;
  std::map<std::string, std::uint32_t> sessions;
  std::size_t heard = 0;  // roster entries

 private:
  std::uint64_t asked_ = 0;
  std::map<std::uint32_t, std::string> names_;
  std::unique_ptr<bus::Bus> bus_;
  std::unique_ptr<bus::Writer<roster::JoinRequest>> requests_;
  std::unique_ptr<bus::Writer<roster::Command>> commands_;
  std::unique_ptr<bus::Reader<roster::JoinReply>> replies_;
  std::unique_ptr<bus::Reader<roster::CommandReply>> command_replies_;
  std::unique_ptr<bus::Reader<roster::RosterEntry>> entries_;
  std::unique_ptr<bus::Reader<roster::SessionState>> states_;
};

class SessionServiceTest : public ::testing::Test {
 protected:
  SessionServiceTest() {
    config_.state_dir = (temporary_ / "state").string();
    config_.sessions = {"stage"};
    config_.limits.coil_slots = 4;
  }
  void Start() {
    pool_ = std::make_unique<test_support::ImmediatePool>();
    lobby_ = bus::inproc::MakeBus(hub_);
    service_ = std::make_unique<SessionService>(
        config_, clock_, *lobby_,
        [this](const std::string& partition) -> Result<std::unique_ptr<bus::Bus>> {
          if (refuse_partitions_) {
            return Error{ErrorCode::kUnavailable, "no free port"};
          }
          return InPartition(hub_, partition);
        },
        *pool_);
    ASSERT_TRUE(service_->Start().ok());
  }
  void Kill() {
    service_.reset();
    lobby_.reset();
  }
  void Pass(Duration duration) {
    for (Duration passed{}; passed < duration; passed += 250ms) {
      clock_.Advance(250ms);
      pool_->RunDue(clock_.Now());
    }
  }
  ServiceHealth Health() {
    ServiceHealth health;
    service_->FillHealth(health);
    return health;
  }
  double Value(const std::string& name) {
    for (const NamedValue& value : Health().values) {
      if (value.name == name) {
        return value.value;
      }
    }
    ADD_FAILURE() << "health has no " << name;
    return -1.0;
  }

  const test_support::TemporaryFolder temporary_;
  test_support::FakeClock clock_;
  std::shared_ptr<bus::inproc::Hub> hub_ = bus::inproc::MakeHub(&clock_);
  SessionConfig config_;
  bool refuse_partitions_ = false;
  std::unique_ptr<test_support::ImmediatePool> pool_;
  std::unique_ptr<bus::Bus> lobby_;
  std::unique_ptr<SessionService> service_;
};

TEST_F(SessionServiceTest, SessionsAreListedCreatedAndClosed) {
  Start();
  Peer lobby(hub_, "");
  EXPECT_THAT(lobby.sessions, ElementsAre(Pair("stage", 0U)));
  EXPECT_TRUE(lobby.Ask(Command(9, CommandKind::kCreateSession, "studio")).accepted);
  EXPECT_THAT(lobby.sessions, UnorderedElementsAre(Pair("stage", 0U), Pair("studio", 0U)));
  EXPECT_EQ(lobby.Ask(Command(9, CommandKind::kCountSessions)).message, "2");
  EXPECT_THAT(lobby.Ask(Command(9, CommandKind::kCreateSession, "studio")).message,
              HasSubstr("already"));
  EXPECT_FALSE(lobby.Ask(Command(9, CommandKind::kCloseSession, "studio")).accepted)
      << "to be asked in the session";
  Peer member(hub_, "studio");
  roster::JoinRequest join = Watches(9, Role::kOperator);
  join.session = "studio";
  EXPECT_TRUE(member.Join(join).accepted);
  EXPECT_TRUE(member.Ask(Command(9, CommandKind::kCloseSession)).accepted);
  EXPECT_THAT(lobby.sessions, ElementsAre(Pair("stage", 0U)));
  EXPECT_TRUE(member.sessions.empty());
  EXPECT_THAT(member.Join(join).message, HasSubstr("there is no session \"studio\""));
  EXPECT_TRUE(lobby.Ask(Command(9, CommandKind::kCreateSession, "studio")).accepted);
  join.request_id = 2;
  EXPECT_TRUE(member.Join(join).accepted) << "the new one of that name";
  EXPECT_THAT(member.sessions, ElementsAre(Pair("studio", 0U)));
}

TEST_F(SessionServiceTest, ARepeatedRequestIsAnsweredAgainAndNotDoneAgain) {
  Start();
  Peer lobby(hub_, "");
  roster::Command create = Command(9, CommandKind::kCreateSession, "studio");
  create.request_id = 41;
  EXPECT_TRUE(lobby.Repeat(create).accepted);
  EXPECT_TRUE(lobby.Repeat(create).accepted);
  create.request_id = 42;
  EXPECT_FALSE(lobby.Repeat(create).accepted) << "another request of the same words";
  EXPECT_THAT(lobby.Repeat(create).message, HasSubstr("already"));
}

TEST_F(SessionServiceTest, WithoutAllowCreateThereAreThoseOfTheConfiguration) {
  config_.allow_create = false;
  Start();
  Peer lobby(hub_, "");
  EXPECT_THAT(lobby.Ask(Command(9, CommandKind::kCreateSession, "studio")).message,
              HasSubstr("session.allow_create"));
  EXPECT_THAT(lobby.sessions, ElementsAre(Pair("stage", 0U)));
}

TEST_F(SessionServiceTest, TheRosterReachesTheSessionAndNobodyElse) {
  Start();
  Peer lobby(hub_, "");
  Peer member(hub_, "stage");
  const roster::JoinReply reply = member.Join(Asks(7, "Ada", 11));
  EXPECT_TRUE(reply.accepted) << reply.message;
  EXPECT_EQ(reply.partition, "stage");
  ASSERT_EQ(member.roster.size(), 1U);
  EXPECT_EQ(member.roster.at(reply.body_id.value).person, "Ada");
  EXPECT_THAT(lobby.sessions, ElementsAre(Pair("stage", 1U)));
  EXPECT_TRUE(lobby.roster.empty());
  EXPECT_EQ(Peer(hub_, "stage").roster, member.roster) << "late joiners at once";
  EXPECT_EQ(member.Join(Asks(7, "Ada", 11)).message, "no answer") << "nothing new";
  EXPECT_TRUE(member.Ask(Command(7, CommandKind::kLeaveSession)).accepted);
  EXPECT_TRUE(member.roster.empty());
  EXPECT_THAT(member.sessions, ElementsAre(Pair("stage", 0U)));
}

TEST_F(SessionServiceTest, WhoVanishesIsReleasedAfterTheGraceTime) {
  Start();
  Peer member(hub_, "stage");
  (void)member.Join(Asks(7, "Ada", 11));
  (void)member.Join(Asks(8, "Bob", 12));
  for (int i = 0; i < 70; ++i) {
    Pass(500ms);
    (void)member.Join(Asks(8, "Bob", 12));
  }
  ASSERT_EQ(member.roster.size(), 1U);
  EXPECT_EQ(member.roster.begin()->second.person, "Bob");
  EXPECT_EQ(Value("members.vanished"), 1.0);
  EXPECT_EQ(Value("members.released"), 1.0);
  EXPECT_EQ(member.Join(Asks(9, "Ada", 11)).body_id.value, 1U);
}

TEST_F(SessionServiceTest, ARestartChangesNothingForAnyone) {
  Start();
  Peer member(hub_, "stage");
  (void)member.Join(Asks(7, "Ada", 11));
  (void)member.Join(Asks(8, "Bob", 12));
  (void)member.Ask(Command(8, CommandKind::kLeaveSession));
  const auto before = member.roster;
  Kill();
  EXPECT_EQ(member.roster, before);
  clock_.Advance(1h);
  Start();
  EXPECT_EQ(member.roster, before);
  EXPECT_EQ(member.Join(Asks(7, "Ada", 11)).body_id.value, 1U);
  EXPECT_EQ(member.Join(Asks(8, "Bob", 12)).body_id.value, 2U);
  EXPECT_EQ(member.Join(Asks(9, "Eve", 13)).body_id.value, 3U);
  EXPECT_EQ(member.roster.at(1), before.at(1));
  EXPECT_EQ(Health().last_error, "");
}

TEST_F(SessionServiceTest, WhatWasAnsweredIsOnTheDisk) {
  Start();
  Peer member(hub_, "stage");
  std::size_t on_disk = 0;
  Peer watcher(hub_, "stage");
  (void)member.Join(Asks(7, "Ada", 11));
  SessionStore store(config_.state_dir);
  on_disk = store.Load()->snapshot.sessions.at(0).people.size();
  EXPECT_EQ(on_disk, 1U);
  const double saves = Value("saves");
  for (int i = 0; i < 10; ++i) {
    Pass(500ms);
    (void)member.Join(Asks(7, "Ada", 11));
  }
  EXPECT_EQ(Value("saves"), saves) << "staying costs no disk";
}

TEST_F(SessionServiceTest, ABrokenFileIsSaidAndSetAside) {
  std::filesystem::create_directories(config_.state_dir);
  std::ofstream(config_.state_dir + "/sessions.toml") << "version = 1\nnext_bo";
  Start();
  EXPECT_THAT(Health().last_error, HasSubstr("sessions.toml"));
  Peer member(hub_, "stage");
  EXPECT_TRUE(member.Join(Asks(7, "Ada", 11)).accepted);
  EXPECT_TRUE(std::filesystem::exists(config_.state_dir + "/sessions.toml.refused"));
  EXPECT_TRUE(SessionStore(config_.state_dir).Load().ok());
}

TEST_F(SessionServiceTest, AFullDiskIsSaidAndSurvived) {
  Start();
  Peer member(hub_, "stage");
  std::filesystem::create_directory(config_.state_dir + "/sessions.toml.new");
  EXPECT_TRUE(member.Join(Asks(7, "Ada", 11)).accepted);
  EXPECT_EQ(member.roster.size(), 1U);
  EXPECT_THAT(Health().last_error, HasSubstr("not saved: "));
  EXPECT_GE(Value("save_errors"), 1.0);
  std::filesystem::remove(config_.state_dir + "/sessions.toml.new");
  Pass(2s);
  EXPECT_EQ(Health().last_error, "");
  EXPECT_EQ(SessionStore(config_.state_dir).Load()->snapshot.sessions.at(0).people.size(), 1U);
}

TEST_F(SessionServiceTest, APartitionThatCannotBeJoinedIsTriedAgain) {
  refuse_partitions_ = true;
  Start();
  EXPECT_THAT(Health().last_error, HasSubstr("session \"stage\": no free port"));
  Peer member(hub_, "stage");
  EXPECT_EQ(member.Join(Asks(7, "Ada", 11)).message, "no answer");
  refuse_partitions_ = false;
  Pass(2s);
  EXPECT_EQ(Health().last_error, "");
  EXPECT_TRUE(member.Join(Asks(7, "Ada", 11, 2)).accepted);
  EXPECT_THAT(member.sessions, ElementsAre(Pair("stage", 1U)));
}

TEST_F(SessionServiceTest, AnotherHostIsNoticed) {
  Start();
  EXPECT_EQ(Health().last_error, "");
  const auto other = bus::inproc::MakeBus(hub_);
  const auto states = *other->MakeWriter<roster::SessionState>();
  EXPECT_THAT(Health().last_error, HasSubstr("another session host"));
  EXPECT_EQ(Value("gauge.other_hosts"), 1.0);
}

TEST_F(SessionServiceTest, TenThousandJoinsASecondAreRefusedAndOthersAreServed) {
  config_.limits.new_members_per_s = 50.0;
  config_.max_refusals_per_s = 100;
  Start();
  Peer member(hub_, "stage");
  Peer attacker(hub_, "stage");
  ASSERT_TRUE(member.Join(Asks(7, "Ada", 11)).accepted);
  std::size_t answers = 0;
  for (std::uint64_t i = 0; i < 10'000; ++i) {
    clock_.Advance(100us);
    attacker.joined.reset();
    (void)attacker.Join(Asks(1000 + i, "P" + std::to_string(i), 1000 + i));
    answers += attacker.joined ? 1U : 0U;
    if (i % 5000 == 0) {
      (void)member.Join(Asks(7, "Ada", 11));
    }
  }
  EXPECT_LE(answers, 360U) << "at most twice 50 and 50 accepted, twice 100 refused";
  EXPECT_GE(answers, 300U);
  EXPECT_LE(Value("gauge.performers"), 152.0);
  EXPECT_GE(Value("refused.too_fast"), 9'800.0);
  EXPECT_GE(Value("refused.unanswered"), 9'600.0);
  EXPECT_EQ(Value("requests.dropped"), 0.0);
  EXPECT_EQ(member.roster.at(1).person, "Ada");
  EXPECT_EQ(Value("members.vanished"), 0.0);
}

TEST_F(SessionServiceTest, WhatDoesNotFitIntoTheQueueIsCounted) {
  Start();
  Peer member(hub_, "stage");
  // A pool that is not called: the worker is busy.
  pool_->Stop();
  for (std::uint64_t i = 0; i < 6000; ++i) {
    (void)member.Join(Asks(i, "P", 1));
  }
  EXPECT_EQ(Value("requests.dropped"), 6000.0 - 4096.0);
}

}  // namespace
}  // namespace limbcast::session
