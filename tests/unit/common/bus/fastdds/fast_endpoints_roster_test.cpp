#include "tests/unit/common/bus/endpoint_round_trip.hpp"

namespace limbcast::bus::testing {
namespace {

TEST(FastEndpointsRosterTest, RosterEntryCrossesUnchanged) {
  ExpectCrossing<roster::RosterEntry>(Vendor::kFast);
}
TEST(FastEndpointsRosterTest, SessionStateCrossesUnchanged) {
  ExpectCrossing<roster::SessionState>(Vendor::kFast);
}
TEST(FastEndpointsRosterTest, JoinRequestCrossesUnchanged) {
  ExpectCrossing<roster::JoinRequest>(Vendor::kFast);
}
TEST(FastEndpointsRosterTest, JoinReplyCrossesUnchanged) {
  ExpectCrossing<roster::JoinReply>(Vendor::kFast);
}
TEST(FastEndpointsRosterTest, CommandCrossesUnchanged) {
  ExpectCrossing<roster::Command>(Vendor::kFast);
}
TEST(FastEndpointsRosterTest, CommandReplyCrossesUnchanged) {
  ExpectCrossing<roster::CommandReply>(Vendor::kFast);
}

}  // namespace
}  // namespace limbcast::bus::testing
