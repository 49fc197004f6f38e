#include "services/session/session_registry.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/unit/services/session/registry_rig.hpp"

namespace limbcast::session {
namespace {

using namespace std::chrono_literals;
using roster::CommandKind;
using roster::Role;
using ::testing::HasSubstr;

class SessionRegistryTest : public ::testing::Test {
 protected:
  SessionRegistryTest() : registry_(Limits()) {
    EXPECT_TRUE(registry_.Create("stage", now_).ok());
    (void)registry_.TakeChanges();
  }
  static RegistryLimits Limits() {
    RegistryLimits limits;
    limits.max_members = 6;
    limits.max_members_of_client = 4;
    limits.max_sessions = 2;
    limits.max_remembered = 2;
    limits.lease = 2s;
    limits.grace = 10s;
    limits.new_members_per_s = 10.0;
    limits.coil_slots = 2;
    return limits;
  }
  roster::JoinReply Join(const roster::JoinRequest& request) {
    return registry_.Join("stage", request, now_).reply;
  }
  // Time passes as for a host that looks several times in a lease.
  void Pass(Duration duration) {
    for (Duration passed{}; passed < duration; passed += 250ms) {
      now_ += 250ms;
      registry_.Expire(now_);
    }
  }
  std::uint64_t Refused(Refusal refusal) const {
    return registry_.counters().refused[static_cast<std::size_t>(refusal)];
  }
  std::vector<roster::RosterEntry> Entries() const { return registry_.Contents("stage")->entries; }

  Time now_ = kStart;
  SessionRegistry registry_;
};

TEST_F(SessionRegistryTest, APerformerGetsABodyAPartitionAndACoilSlot) {
  const roster::JoinReply reply = Join(Asks(7, "Ada", 11, 3));
  EXPECT_TRUE(reply.accepted) << reply.message;
  EXPECT_EQ(reply.client_uid, 7U);
  EXPECT_EQ(reply.request_id, 3U);
  EXPECT_EQ(reply.body_id.value, 1U);
  EXPECT_EQ(reply.partition, "stage");
  ASSERT_EQ(Entries().size(), 1U);
  const roster::RosterEntry entry = Entries()[0];
  EXPECT_EQ(entry.person, "Ada");
  EXPECT_EQ(entry.session, "stage");
  EXPECT_EQ(entry.coil_slot, 1U);
  EXPECT_EQ(entry.sensors, (std::vector{On(body::Segment::kPelvis, 11)}));
  EXPECT_EQ(registry_.Contents("stage")->state.performer_count, 1U);
}

TEST_F(SessionRegistryTest, OnlyWhoWearsCoilsTakesASlotAndIsToldOfItsFrame) {
  roster::JoinRequest without = Asks(7, "Ada", 11);
  without.wants_coil_slot = false;
  EXPECT_TRUE(Join(without).accepted);
  EXPECT_TRUE(Join(Asks(8, "Bob", 12)).accepted);
  EXPECT_TRUE(Join(Asks(9, "Cyd", 13)).accepted);
  EXPECT_EQ(Entries()[0].coil_slot, 0U);
  EXPECT_EQ(Entries()[0].coil_slots, 0U);
  EXPECT_EQ(Entries()[1].coil_slot, 1U);
  EXPECT_EQ(Entries()[2].coil_slot, 2U);
  EXPECT_EQ(Entries()[2].coil_slots, 2U);
  EXPECT_EQ(Entries()[2].coil_frame_us, 200'000U);
}

TEST_F(SessionRegistryTest, ASlotThatBecomesFreeGoesToWhoWaitsForOne) {
  EXPECT_TRUE(Join(Asks(7, "Ada", 11)).accepted);
  EXPECT_TRUE(Join(Asks(8, "Bob", 12)).accepted);
  EXPECT_TRUE(Join(Asks(9, "Zoe", 13)).accepted);
  EXPECT_TRUE(Join(Asks(10, "Cyd", 14)).accepted);
  ASSERT_EQ(Entries()[3].person, "Zoe");
  EXPECT_EQ(Entries()[3].coil_slot, 0U) << "there are two";
  const std::uint32_t revision = Entries()[3].revision;
  EXPECT_TRUE(registry_.Do("stage", Command(8, CommandKind::kLeaveSession, "Bob"), now_).ok());
  ASSERT_EQ(Entries().size(), 3U);
  EXPECT_EQ(Entries()[2].person, "Zoe") << "who came before Cyd";
  EXPECT_EQ(Entries()[2].coil_slot, 2U);
  EXPECT_GT(Entries()[2].revision, revision);
  EXPECT_EQ(Entries()[1].coil_slot, 0U);
}

TEST_F(SessionRegistryTest, AGatewayThatReturnsWithoutCoilsGivesTheSlotBackAndWithThemTakesOne) {
  EXPECT_TRUE(Join(Asks(7, "Ada", 11)).accepted);
  EXPECT_TRUE(Join(Asks(8, "Bob", 12)).accepted);
  Pass(1s);
  roster::JoinRequest again = Asks(70, "Ada", 11);
  again.wants_coil_slot = false;
  EXPECT_TRUE(Join(again).accepted);
  EXPECT_EQ(Entries()[0].coil_slot, 0U);
  EXPECT_EQ(Entries()[1].coil_slot, 2U);
  Pass(1s);
  EXPECT_TRUE(Join(Asks(71, "Ada", 11)).accepted);
  EXPECT_EQ(Entries()[0].coil_slot, 1U);
  EXPECT_EQ(Entries()[1].coil_slot, 2U);
}

TEST_F(SessionRegistryTest, ARepeatedRequestChangesNothingAndNeedsNoAnswer) {
  EXPECT_TRUE(registry_.Join("stage", Asks(7, "Ada", 11), now_).is_news);
  (void)registry_.TakeChanges();
  (void)registry_.TakeDirty();
  const auto again = registry_.Join("stage", Asks(7, "Ada", 11), now_);
  EXPECT_TRUE(again.reply.accepted);
  EXPECT_FALSE(again.is_news);
  EXPECT_TRUE(registry_.TakeChanges().empty());
  EXPECT_FALSE(registry_.TakeDirty());
  EXPECT_TRUE(registry_.Join("stage", Asks(7, "Ada", 11, 2), now_).is_news)
      << "whoever asks anew has not heard the answer";
}

TEST_F(SessionRegistryTest, OtherSensorsOfTheSameClientAreTakenOver) {
  (void)Join(Asks(7, "Ada", 11));
  const std::uint32_t before = Entries()[0].revision;
  EXPECT_TRUE(Join(Asks(7, "Ada", 12)).accepted);
  EXPECT_EQ(Entries()[0].sensors[0].sensor_uid.value, 12U);
  EXPECT_GT(Entries()[0].revision, before);
  EXPECT_TRUE(Join(Asks(8, "Bob", 11)).accepted) << "the one that Ada put away is free";
}

TEST_F(SessionRegistryTest, APersonIsCarriedByOneClientThatIsAlive) {
  (void)Join(Asks(7, "Ada", 11));
  const roster::JoinReply second = Join(Asks(8, "Ada", 12));
  EXPECT_FALSE(second.accepted);
  EXPECT_EQ(second.body_id.value, 0U);
  EXPECT_THAT(second.message, HasSubstr("through another client"));
  EXPECT_EQ(Refused(Refusal::kPersonTaken), 1U);
  Pass(3s);
  const roster::JoinReply taken_over = Join(Asks(8, "Ada", 12));
  EXPECT_TRUE(taken_over.accepted) << taken_over.message;
  EXPECT_EQ(taken_over.body_id.value, 1U);
  EXPECT_FALSE(Join(Asks(7, "Ada", 11)).accepted) << "the first one is late";
}

TEST_F(SessionRegistryTest, AClientStartedAgainCarriesItsPersonOnAfterThreeMissedRenewals) {
  (void)Join(Asks(7, "Ada", 11));
  Pass(500ms);
  EXPECT_FALSE(Join(Asks(8, "Ada", 11)).accepted) << "the old one may still be there";
  EXPECT_TRUE(Join(Asks(7, "Ada", 11)).accepted);
  Pass(500ms);
  EXPECT_FALSE(Join(Asks(8, "Ada", 11)).accepted) << "it was";
  Pass(250ms);
  EXPECT_FALSE(Join(Asks(8, "Ada", 12)).accepted) << "somebody else of that name";
  EXPECT_FALSE(Join(AsksBare(8, "Ada")).accepted) << "anybody";
  (void)registry_.TakeChanges();
  const roster::JoinReply restarted = Join(Asks(8, "Ada", 11));
  EXPECT_TRUE(restarted.accepted) << restarted.message;
  EXPECT_EQ(restarted.body_id.value, 1U);
  EXPECT_TRUE(registry_.TakeChanges().empty()) << "nobody has to be told";
  EXPECT_EQ(registry_.counters().vanished, 0U);
  EXPECT_FALSE(Join(Asks(7, "Ada", 11)).accepted) << "the first one is late";
}

TEST_F(SessionRegistryTest, WhoVanishesStaysForTheGraceTimeAndReturnsAsTheSameBody) {
  (void)Join(Asks(7, "Ada", 11));
  (void)Join(Asks(8, "Bob", 12));
  Pass(4s);
  EXPECT_EQ(registry_.counters().vanished, 2U);
  EXPECT_EQ(Entries().size(), 2U) << "a dropout is nobody's business";
  EXPECT_TRUE(Join(Asks(7, "Ada", 11)).accepted);
  for (int i = 0; i < 20; ++i) {
    Pass(500ms);
    (void)Join(Asks(7, "Ada", 11));
  }
  ASSERT_EQ(Entries().size(), 1U);
  EXPECT_EQ(Entries()[0].person, "Ada");
  EXPECT_EQ(registry_.counters().released, 1U);
  EXPECT_EQ(registry_.remembered_count(), 1U);
  const roster::JoinReply back = Join(AsksBare(9, "Bob"));
  EXPECT_TRUE(back.accepted) << back.message;
  EXPECT_EQ(back.body_id.value, 2U);
  EXPECT_EQ(Entries()[1].sensors[0].sensor_uid.value, 12U) << "wears what it wore";
  EXPECT_EQ(Entries()[1].coil_slot, 2U);
}

TEST_F(SessionRegistryTest, ASensorIsWornByOneWhoIsAlive) {
  ASSERT_TRUE(registry_.Create("studio", now_).ok());
  (void)Join(Asks(7, "Ada", 11));
  roster::JoinRequest bob = Asks(8, "Bob", 11);
  bob.session = "studio";
  const auto refused = registry_.Join("studio", bob, now_).reply;
  EXPECT_FALSE(refused.accepted);
  EXPECT_THAT(refused.message,
              HasSubstr("000000000000000b is worn by \"Ada\" in session \"stage\""));
  Pass(3s);
  (void)registry_.TakeChanges();
  EXPECT_TRUE(registry_.Join("studio", bob, now_).reply.accepted);
  EXPECT_TRUE(Entries().empty()) << "Ada vanished and somebody else wears her sensor";
  const auto changes = registry_.TakeChanges();
  ASSERT_GE(changes.size(), 2U);
  EXPECT_EQ(std::get<EntryGone>(changes[0]).entry.person, "Ada");
  EXPECT_EQ(std::get<EntryChanged>(changes[1]).entry.person, "Bob");
  EXPECT_FALSE(Join(AsksBare(7, "Ada")).accepted) << "until Bob leaves";
}

TEST_F(SessionRegistryTest, TwoSessionsWithTheSameNamesDoNotMix) {
  ASSERT_TRUE(registry_.Create("studio", now_).ok());
  (void)Join(Asks(7, "Ada", 11));
  roster::JoinRequest other = Asks(8, "Ada", 12);
  other.session = "studio";
  const auto reply = registry_.Join("studio", other, now_).reply;
  EXPECT_TRUE(reply.accepted);
  EXPECT_EQ(reply.body_id.value, 2U) << "ids are unique over all sessions";
  EXPECT_EQ(reply.partition, "studio");
  EXPECT_EQ(Entries().size(), 1U);
  EXPECT_EQ(registry_.Contents("studio")->entries.size(), 1U);
}

TEST_F(SessionRegistryTest, SensorsThatCannotBeAreRefused) {
  using body::Segment;
  EXPECT_THAT(Join(AsksBare(7, "Ada")).message, HasSubstr("at least one sensor"));
  EXPECT_THAT(Join(Asks(7, "Ada", 0)).message, HasSubstr("not 0"));
  EXPECT_THAT(Join(Asks(7, "Ada", {On(Segment::kHead, 1), On(Segment::kHead, 2)})).message,
              HasSubstr("two sensors on segment head"));
  EXPECT_THAT(Join(Asks(7, "Ada", {On(Segment::kHead, 1), On(Segment::kPelvis, 1)})).message,
              HasSubstr("on two segments"));
  EXPECT_EQ(Refused(Refusal::kBadSensors), 4U);
  EXPECT_TRUE(Entries().empty());
}

TEST_F(SessionRegistryTest, WrongSessionsAndNamesAreRefusedWithTheReason) {
  EXPECT_THAT(registry_.Join("nowhere", Asks(7, "Ada", 1), now_).reply.message,
              HasSubstr("there is no session \"nowhere\""));
  roster::JoinRequest elsewhere = Asks(7, "Ada", 1);
  elsewhere.session = "studio";
  EXPECT_THAT(registry_.Join("stage", elsewhere, now_).reply.message,
              HasSubstr("this is session \"stage\", not \"studio\""));
  EXPECT_THAT(Join(Asks(7, "", 1)).message, HasSubstr("1 to 64"));
  EXPECT_THAT(Join(Asks(7, "A\nda", 1)).message, HasSubstr("control characters"));
  EXPECT_EQ(registry_.Create("a*", now_).error().code, ErrorCode::kInvalidArgument);
  EXPECT_THAT(registry_.Create("stage", now_).error().message, HasSubstr("already"));
  EXPECT_EQ(Refused(Refusal::kWrongSession), 2U);
  EXPECT_EQ(Refused(Refusal::kBadName), 3U);
  EXPECT_EQ(Refused(Refusal::kExists), 1U);
}

TEST_F(SessionRegistryTest, NoLimitIsExceeded) {
  EXPECT_TRUE(registry_.Create("second", now_).ok());
  EXPECT_THAT(registry_.Create("third", now_).error().message, HasSubstr("its 2 sessions"));
  for (std::uint64_t i = 1; i <= 4; ++i) {
    EXPECT_TRUE(Join(Asks(7, "P" + std::to_string(i), i)).accepted);
  }
  EXPECT_THAT(Join(Asks(7, "P5", 5)).message, HasSubstr("one client may join 4 times"));
  EXPECT_TRUE(Join(Watches(8, Role::kSpectator)).accepted);
  EXPECT_TRUE(Join(Watches(9, Role::kSpectator)).accepted);
  EXPECT_FALSE(registry_.Contents("stage")->state.open);
  EXPECT_THAT(Join(Watches(10, Role::kSpectator)).message, HasSubstr("its 6 members"));
  EXPECT_TRUE(Join(Asks(7, "P1", 1)).accepted) << "who is there stays";
  EXPECT_EQ(Refused(Refusal::kFull), 3U);
  EXPECT_EQ(Entries()[2].coil_slot, 0U) << "there are two";
}

TEST_F(SessionRegistryTest, NewMembersComeOnlySoFast) {
  RegistryLimits limits = Limits();
  limits.max_members = 4096;
  limits.max_remembered = 50;
  SessionRegistry registry(limits);
  ASSERT_TRUE(registry.Create("stage", now_).ok());
  std::size_t accepted = 0;
  for (std::uint64_t i = 1; i <= 10'000; ++i) {  // 10 000 in one second
    now_ += 100us;
    accepted += registry.Join("stage", Asks(i, "P" + std::to_string(i), i), now_).reply.accepted;
    (void)registry.TakeChanges();
  }
  EXPECT_GE(accepted, 29U);
  EXPECT_LE(accepted, 31U);
  EXPECT_EQ(registry.counters().refused[static_cast<std::size_t>(Refusal::kTooFast)],
            10'000U - accepted);
  EXPECT_TRUE(registry.Join("stage", Asks(1, "P1", 1), now_).reply.accepted)
      << "who is there is not held up";
}

TEST_F(SessionRegistryTest, WhoLeavesIsGoneAtOnceAndRememberedForAWhile) {
  for (std::uint64_t i = 1; i <= 3; ++i) {
    (void)Join(Asks(i, "P" + std::to_string(i), i));
    now_ += 100ms;
    EXPECT_TRUE(registry_.Do("stage", Command(i, CommandKind::kLeaveSession), now_).ok());
  }
  EXPECT_TRUE(Entries().empty());
  EXPECT_EQ(registry_.remembered_count(), 2U) << "max_remembered";
  EXPECT_EQ(Join(AsksBare(9, "P3")).body_id.value, 3U);
  EXPECT_EQ(Join(Asks(9, "P1", 1)).body_id.value, 4U) << "forgotten: the oldest";
  EXPECT_EQ(registry_.Do("stage", Command(77, CommandKind::kLeaveSession), now_).error().code,
            ErrorCode::kNotFound);
  EXPECT_EQ(Refused(Refusal::kNotMember), 1U);
}

TEST_F(SessionRegistryTest, AClientLeavesForOneOfItsPeople) {
  (void)Join(Asks(7, "Ada", 1));
  (void)Join(Asks(7, "Bob", 2));
  (void)Join(Watches(7, Role::kSpectator, "Ada"));
  EXPECT_TRUE(registry_.Do("stage", Command(7, CommandKind::kLeaveSession, "Ada"), now_).ok());
  ASSERT_EQ(Entries().size(), 1U);
  EXPECT_EQ(Entries()[0].person, "Bob");
  EXPECT_EQ(registry_.watcher_count(), 0U);
}

TEST_F(SessionRegistryTest, OnlyOperatorsSendAwayAndClose) {
  (void)Join(Asks(7, "Ada", 11));
  (void)Join(Watches(8, Role::kSpectator));
  const auto close = Command(8, CommandKind::kCloseSession);
  EXPECT_THAT(registry_.Do("stage", close, now_).error().message, HasSubstr("only an operator"));
  EXPECT_FALSE(registry_.Do("stage", Command(7, CommandKind::kReleasePerson, "Ada"), now_).ok());
  EXPECT_TRUE(Join(Watches(8, Role::kOperator)).accepted);
  EXPECT_TRUE(registry_.Do("stage", Command(8, CommandKind::kReleasePerson, "Ada"), now_).ok());
  EXPECT_TRUE(Entries().empty());
  EXPECT_EQ(
      registry_.Do("stage", Command(8, CommandKind::kReleasePerson, "Ada"), now_).error().code,
      ErrorCode::kNotFound);
  (void)Join(Asks(7, "Ada", 11));
  (void)registry_.TakeChanges();
  EXPECT_TRUE(registry_.Do("stage", close, now_).ok());
  EXPECT_EQ(registry_.session_count(), 0U);
  EXPECT_EQ(registry_.performer_count(), 0U);
  EXPECT_EQ(registry_.watcher_count(), 0U);
  const auto changes = registry_.TakeChanges();
  ASSERT_EQ(changes.size(), 2U);
  EXPECT_TRUE(std::holds_alternative<EntryGone>(changes[0]));
  EXPECT_EQ(std::get<SessionClosed>(changes[1]).state.name, "stage");
  EXPECT_TRUE(registry_.Create("stage", now_).ok());
  EXPECT_EQ(Join(Asks(7, "Ada", 11)).body_id.value, 2U) << "another session, another Ada";
}

TEST_F(SessionRegistryTest, AnOperatorWhoFellSilentIsNone) {
  (void)Join(Watches(8, Role::kOperator));
  Pass(3s);
  EXPECT_EQ(registry_.watcher_count(), 0U);
  EXPECT_FALSE(registry_.Do("stage", Command(8, CommandKind::kCloseSession), now_).ok());
  EXPECT_EQ(Refused(Refusal::kNotOperator), 1U);
}

TEST_F(SessionRegistryTest, TimeInWhichTheHostWasAwayCountsForNobody) {
  (void)Join(Asks(7, "Ada", 11));
  (void)Join(Watches(8, Role::kSpectator));
  registry_.Expire(now_);
  for (const Duration jump : {Duration(1h), Duration(-2h)}) {  // suspended; the clock was set
    now_ += jump;
    registry_.Expire(now_);
    Pass(1s);
    EXPECT_EQ(registry_.counters().vanished, 0U);
  }
  Pass(1s);
  EXPECT_EQ(registry_.counters().vanished, 2U) << "and not for ever";
}

}  // namespace
}  // namespace limbcast::session
