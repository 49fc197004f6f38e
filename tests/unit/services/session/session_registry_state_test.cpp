// What is told and what is kept follows from the rules, whatever is asked in whatever order.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <map>
#include <set>

#include "services/session/session_registry.hpp"
#include "tests/unit/services/session/registry_rig.hpp"

namespace limbcast::session {
namespace {

using namespace std::chrono_literals;
using roster::CommandKind;
using roster::Role;
using ::testing::HasSubstr;

RegistryLimits SmallLimits() {
  RegistryLimits limits;
  limits.max_sessions = 2;
  limits.max_members = 5;
  limits.max_members_of_client = 3;
  limits.max_remembered = 3;
  limits.grace = 3s;
  limits.new_members_per_s = 5.0;
  limits.coil_slots = 2;
  return limits;
}

// A network of readers: what changes tell, put together.
struct World {
  std::map<std::string, std::uint32_t> open;                             // session, performers
  std::map<std::string, std::map<BodyId, roster::RosterEntry>> entries;  // by session

  void Hear(const std::vector<Change>& changes) {
    for (const Change& change : changes) {
      if (const auto* opened = std::get_if<SessionOpened>(&change)) {
        open[opened->state.name] = opened->state.performer_count;
      } else if (const auto* changed = std::get_if<SessionChanged>(&change)) {
        RC_ASSERT(open.contains(changed->state.name));
        open[changed->state.name] = changed->state.performer_count;
      } else if (const auto* closed = std::get_if<SessionClosed>(&change)) {
        RC_ASSERT(entries[closed->state.name].empty());
        open.erase(closed->state.name);
      } else if (const auto* entry = std::get_if<EntryChanged>(&change)) {
        const auto before = entries[entry->entry.session].find(entry->entry.body_id);
        // In parentheses: what RC_ASSERT takes apart is not evaluated from left to right.
        RC_ASSERT((before == entries[entry->entry.session].end() ||
                   before->second.revision < entry->entry.revision));
        entries[entry->entry.session][entry->entry.body_id] = entry->entry;
      } else if (const auto* gone = std::get_if<EntryGone>(&change)) {
        RC_ASSERT(entries[gone->entry.session].erase(gone->entry.body_id) == 1U);
      }
    }
  }
};

void CheckInvariants(const SessionRegistry& registry, const World& world) {
  const RegistryLimits limits = SmallLimits();
  std::set<BodyId> bodies;
  std::set<SensorUid> worn;
  std::size_t performers = 0;
  std::size_t remembered = 0;
  const SessionSnapshot snapshot = registry.Snapshot();
  RC_ASSERT(snapshot.sessions.size() <= limits.max_sessions);
  RC_ASSERT(snapshot.sessions.size() == world.open.size());
  for (const KnownSession& session : snapshot.sessions) {
    std::set<std::uint32_t> slots;
    std::uint32_t here = 0;
    for (const KnownPerson& person : session.people) {
      RC_ASSERT(bodies.insert(person.body_id).second);
      RC_ASSERT(person.body_id.value < snapshot.next_body_id);
      if (!person.here) {
        ++remembered;
        continue;
      }
      ++here;
      RC_ASSERT(person.coil_slot <= limits.coil_slots);
      RC_ASSERT((person.coil_slot == 0 || slots.insert(person.coil_slot).second));
      for (const roster::SensorAssignment& sensor : person.sensors) {
        RC_ASSERT(worn.insert(sensor.sensor_uid).second);
      }
    }
    performers += here;
    RC_ASSERT(here <= limits.max_members);
    RC_ASSERT(world.open.at(session.name) == here);
    // A reader that was there all the time knows what one that comes now is told.
    std::map<BodyId, roster::RosterEntry> told;
    const std::optional<SessionContents> contents = registry.Contents(session.name);
    for (const roster::RosterEntry& entry : contents->entries) {
      told[entry.body_id] = entry;
    }
    const auto heard = world.entries.find(session.name);
    RC_ASSERT(told == (heard == world.entries.end() ? decltype(told){} : heard->second));
  }
  RC_ASSERT(performers == registry.performer_count());
  RC_ASSERT(remembered == registry.remembered_count());
  RC_ASSERT(remembered <= limits.max_remembered);
}

RC_GTEST_PROP(SessionRegistryProperty, WhateverIsAskedTheRulesHold, ()) {
  Time now = kStart;
  SessionRegistry registry(SmallLimits());
  World world;
  // Session and person to body, while the session lives and the person is not forgotten.
  std::map<std::pair<std::string, std::string>, BodyId> given;
  const std::vector<std::string> sessions = {"a", "b", "c"};
  const int steps = *rc::gen::inRange(1, 120);
  for (int step = 0; step < steps; ++step) {
    const std::string session = *rc::gen::elementOf(sessions);
    const auto client = *rc::gen::inRange<std::uint64_t>(1, 5);
    const std::string person = "P" + std::to_string(*rc::gen::inRange(0, 6));
    switch (*rc::gen::inRange(0, 10)) {
      case 0:
        (void)registry.Create(session, now);
        break;
      case 1:
        (void)registry.Do(session, Command(client, CommandKind::kLeaveSession, person), now);
        break;
      case 2:
        (void)registry.Do(session, Command(client, CommandKind::kReleasePerson, person), now);
        break;
      case 3:
        if (registry.Do(session, Command(client, CommandKind::kCloseSession), now)) {
          std::erase_if(given, [&](const auto& entry) { return entry.first.first == session; });
        }
        break;
      case 4:
      case 5: {
        roster::JoinRequest watches =
            Watches(client, *rc::gen::element(Role::kSpectator, Role::kOperator));
        watches.session = session;
        (void)registry.Join(session, watches, now);
        break;
      }
      case 6: {
        const int quarters = *rc::gen::inRange(1, 40);
        for (int i = 0; i < quarters; ++i) {
          now += 250ms;
          registry.Expire(now);
        }
        break;
      }
      case 7: {  // a restart
        auto restored = SessionRegistry::Restore(SmallLimits(), registry.Snapshot(), now);
        RC_ASSERT(restored.ok());
        RC_ASSERT(restored->Snapshot() == registry.Snapshot());
        world.Hear(registry.TakeChanges());
        registry = std::move(*restored);
        World again;
        again.Hear(registry.TakeChanges());
        std::erase_if(world.entries, [](const auto& entry) { return entry.second.empty(); });
        RC_ASSERT(again.entries == world.entries);
        break;
      }
      default: {
        roster::JoinRequest request = AsksBare(client, person);
        request.session = session;
        const int count = *rc::gen::inRange(0, 3);
        for (int i = 0; i < count; ++i) {
          request.sensors.push_back(
              On(static_cast<body::Segment>(i), *rc::gen::inRange<std::uint64_t>(0, 8)));
        }
        const roster::JoinReply reply = registry.Join(session, request, now).reply;
        if (reply.accepted) {
          RC_ASSERT(reply.body_id.value != 0U);
          const auto known = given.find({session, person});
          if (known != given.end() && known->second != reply.body_id) {
            // Only after it had been forgotten: never a number that somebody had.
            RC_ASSERT(reply.body_id > known->second);
          }
          given[{session, person}] = reply.body_id;
        } else {
          RC_ASSERT(!reply.message.empty());
          RC_ASSERT(reply.message.size() <= 255U);
        }
      }
    }
    world.Hear(registry.TakeChanges());
    CheckInvariants(registry, world);
  }
}

TEST(SessionRegistryStateTest, WhoWasThereBeforeARestartHasAWholeLeaseToSpeakUp) {
  SessionRegistry before(SmallLimits());
  ASSERT_TRUE(before.Create("stage", kStart).ok());
  (void)before.Join("stage", Asks(7, "Ada", 11), kStart);
  (void)before.Join("stage", Asks(8, "Bob", 12), kStart);
  const Time later = kStart + 1h;
  auto after = SessionRegistry::Restore(SmallLimits(), before.Snapshot(), later);
  ASSERT_TRUE(after.ok());
  EXPECT_FALSE(after->TakeDirty());
  EXPECT_FALSE(after->Join("stage", Asks(9, "Ada", 11), later).reply.accepted)
      << "her client may only be slow";
  const auto renewed = after->Join("stage", Asks(7, "Ada", 11), later);
  EXPECT_TRUE(renewed.reply.accepted);
  EXPECT_EQ(renewed.reply.body_id.value, 1U);
  EXPECT_FALSE(after->TakeDirty());
  for (int i = 0; i < 10; ++i) {
    after->Expire(later + i * 250ms);
  }
  EXPECT_EQ(after->counters().vanished, 2U);
}

TEST(SessionRegistryStateTest, ASnapshotThatContradictsItselfIsRefused) {
  SessionRegistry registry(SmallLimits());
  ASSERT_TRUE(registry.Create("stage", kStart).ok());
  (void)registry.Join("stage", Asks(7, "Ada", 11), kStart);
  (void)registry.Join("stage", Asks(8, "Bob", 12), kStart);
  const SessionSnapshot good = registry.Snapshot();
  const auto refusal = [&](auto&& spoil) {
    SessionSnapshot bad = good;
    spoil(bad);
    const auto restored = SessionRegistry::Restore(SmallLimits(), bad, kStart);
    EXPECT_FALSE(restored.ok());
    EXPECT_EQ(restored.error().code, ErrorCode::kCorruptData);
    return restored.error().message;
  };
  EXPECT_THAT(refusal([](auto& s) { s.next_body_id = 2; }), HasSubstr("body 2 given twice"));
  EXPECT_THAT(refusal([](auto& s) { s.sessions[0].people[1].body_id = {1}; }),
              HasSubstr("given twice"));
  EXPECT_THAT(refusal([](auto& s) { s.sessions[0].people[1].person = "Ada"; }), HasSubstr("twice"));
  EXPECT_THAT(refusal([](auto& s) { s.sessions[0].people[1].person = "\x01"; }),
              HasSubstr("control"));
  EXPECT_THAT(refusal([](auto& s) { s.sessions[0].people[1].sensors[0].sensor_uid = {11}; }),
              HasSubstr("worn by two"));
  EXPECT_THAT(refusal([](auto& s) { s.sessions[0].people[1].sensors.clear(); }),
              HasSubstr("at least one sensor"));
  EXPECT_THAT(refusal([](auto& s) { s.sessions[0].people[1].coil_slot = 1; }),
              HasSubstr("coil slot 1"));
  EXPECT_THAT(refusal([](auto& s) { s.sessions[0].name = "a,b"; }), HasSubstr("characters"));
  EXPECT_THAT(refusal([](auto& s) { s.sessions.push_back(s.sessions[0]); }), HasSubstr("twice"));
  EXPECT_THAT(refusal([](auto& s) { s.sessions.resize(3); }), HasSubstr("max_sessions is 2"));
}

TEST(SessionRegistryStateTest, LimitsAreChecked) {
  EXPECT_TRUE(Validate(RegistryLimits{}).ok());
  RegistryLimits limits;
  limits.lease = 100ms;
  EXPECT_THAT(Validate(limits).error().message, HasSubstr("lease_s must be in [1, 60], is 0.1"));
}

}  // namespace
}  // namespace limbcast::session
