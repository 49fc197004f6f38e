#include "tests/unit/common/bus/wire/codec_properties.hpp"

namespace limbcast::bus::testing {
namespace {

using SessionTopics =
    ::testing::Types<roster::RosterEntry, roster::SessionState, roster::JoinRequest,
                     roster::JoinReply, roster::Command, roster::CommandReply>;
INSTANTIATE_TYPED_TEST_SUITE_P(Session, CodecTest, SessionTopics);

TEST(SessionCodecTest, WhatIsTooLongIsRefusedByName) {
  ExpectOutOfBounds(roster::Command{.numbers = std::vector<double>(65)},
                    "command.numbers has 65 elements, at most 64 are allowed");
  ExpectOutOfBounds(roster::CommandReply{.message = std::string(256, 'm')},
                    "command_reply.message has 256 characters, at most 255 are allowed");
  ExpectOutOfBounds(roster::RosterEntry{.sensors = std::vector<roster::SensorAssignment>(65)},
                    "roster.sensors has 65 elements, at most 64 are allowed");
  ExpectOutOfBounds(roster::JoinRequest{.sensors = std::vector<roster::SensorAssignment>(65)},
                    "join_request.sensors has 65 elements, at most 64 are allowed");
  ExpectOutOfBounds(roster::JoinRequest{.session = std::string(65, 's')},
                    "join_request.session has 65 characters, at most 64 are allowed");
}

TEST(SessionCodecTest, NumbersThatAreNoEnumeratorsAreRefused) {
  wire::Command command;
  command.kind(13);
  ExpectCorrupt<roster::Command>(command,
                                 "command.kind has 13 as its number, at most 12 are allowed");
  wire::JoinRequest request;
  request.role(3);
  ExpectCorrupt<roster::JoinRequest>(
      request, "join_request.role has 3 as its number, at most 2 are allowed");
}

}  // namespace
}  // namespace limbcast::bus::testing
