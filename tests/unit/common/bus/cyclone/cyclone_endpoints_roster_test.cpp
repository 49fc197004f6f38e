#include "tests/unit/common/bus/endpoint_round_trip.hpp"

namespace limbcast::bus::testing {
namespace {

TEST(CycloneEndpointsRosterTest, RosterEntryCrossesUnchanged) {
  ExpectCrossing<roster::RosterEntry>(Vendor::kCyclone);
}
TEST(CycloneEndpointsRosterTest, SessionStateCrossesUnchanged) {
  ExpectCrossing<roster::SessionState>(Vendor::kCyclone);
}
TEST(CycloneEndpointsRosterTest, JoinRequestCrossesUnchanged) {
  ExpectCrossing<roster::JoinRequest>(Vendor::kCyclone);
}
TEST(CycloneEndpointsRosterTest, JoinReplyCrossesUnchanged) {
  ExpectCrossing<roster::JoinReply>(Vendor::kCyclone);
}
TEST(CycloneEndpointsRosterTest, CommandCrossesUnchanged) {
  ExpectCrossing<roster::Command>(Vendor::kCyclone);
}
TEST(CycloneEndpointsRosterTest, CommandReplyCrossesUnchanged) {
  ExpectCrossing<roster::CommandReply>(Vendor::kCyclone);
}

}  // namespace
}  // namespace limbcast::bus::testing
