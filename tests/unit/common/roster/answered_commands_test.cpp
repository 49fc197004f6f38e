#include "common/roster/answered_commands.hpp"

#include <gtest/gtest.h>

#include <string>

namespace limbcast::roster {
namespace {

Command Request(std::uint64_t client_uid, std::uint64_t request_id) {
  Command command;
  command.client_uid = client_uid;
  command.request_id = request_id;
  return command;
}

CommandReply Reply(std::uint64_t client_uid, std::uint64_t request_id) {
  CommandReply reply;
  reply.client_uid = client_uid;
  reply.request_id = request_id;
  reply.message = "answer " + std::to_string(request_id);
  return reply;
}

TEST(AnsweredCommandsTest, OnlyTheVerySameRequestHasAnAnswer) {
  AnsweredCommands answered;
  EXPECT_EQ(answered.Find(Request(7, 1)), nullptr);
  answered.Add(Reply(7, 1));
  ASSERT_NE(answered.Find(Request(7, 1)), nullptr);
  EXPECT_EQ(answered.Find(Request(7, 1))->message, "answer 1");
  EXPECT_EQ(answered.Find(Request(7, 2)), nullptr);
  EXPECT_EQ(answered.Find(Request(8, 1)), nullptr);
  answered.Add(Reply(7, 2));
  EXPECT_EQ(answered.Find(Request(7, 1)), nullptr);
  EXPECT_NE(answered.Find(Request(7, 2)), nullptr);
}

TEST(AnsweredCommandsTest, TheOldestAreForgotten) {
  AnsweredCommands answered;
  for (std::uint64_t client = 1; client <= AnsweredCommands::kMost + 10; ++client) {
    answered.Add(Reply(client, 1));
  }
  EXPECT_EQ(answered.size(), AnsweredCommands::kMost);
  EXPECT_EQ(answered.Find(Request(10, 1)), nullptr);
  EXPECT_NE(answered.Find(Request(11, 1)), nullptr);
}

}  // namespace
}  // namespace limbcast::roster
