#include "services/session/session_room.hpp"

#include <gtest/gtest.h>

#include <vector>

#include "tests/unit/services/session/registry_rig.hpp"

namespace limbcast::session {
namespace {

TEST(SessionRoomTest, HearsWhatIsForTheSessionHostInItsOwnPartition) {
  const auto hub = bus::inproc::MakeHub();
  std::vector<std::uint64_t> joins;
  std::vector<roster::CommandKind> commands;
  auto room = SessionRoom::Make(
      InPartition(hub, "stage"),
      {.on_join = [&](const roster::JoinRequest& r) { joins.push_back(r.client_uid); },
       .on_command = [&](const roster::Command& c) { commands.push_back(c.kind); }});
  ASSERT_TRUE(room.ok());
  for (const char* partition : {"stage", "studio", ""}) {
    const auto bus = InPartition(hub, partition);
    const auto requests = *bus->MakeWriter<roster::JoinRequest>();
    const auto asks = *bus->MakeWriter<roster::Command>();
    ASSERT_TRUE(requests->Write(Asks(7, "Ada", 11)).ok());
    for (int kind = 0; kind <= static_cast<int>(roster::CommandKind::kCountSessions); ++kind) {
      ASSERT_TRUE(asks->Write(Command(7, static_cast<roster::CommandKind>(kind))).ok());
    }
  }
  EXPECT_EQ(joins, std::vector<std::uint64_t>{7});
  EXPECT_EQ(commands,
            (std::vector{roster::CommandKind::kCreateSession, roster::CommandKind::kCloseSession,
                         roster::CommandKind::kLeaveSession, roster::CommandKind::kReleasePerson,
                         roster::CommandKind::kCountSessions}));
}

}  // namespace
}  // namespace limbcast::session
