#include "services/gateway/gateway_command_line.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <vector>

#include "services/gateway/drivers/replay/replay_driver.hpp"
#include "services/gateway/gateway_config.hpp"

namespace limbcast::gateway {
namespace {

using ::testing::HasSubstr;

struct Settings {
  std::optional<int> status;
  GatewayConfig gateway;
  ReplayConfig replay;
  Status read;
};

Settings Parse(std::vector<const char*> arguments) {
  arguments.insert(arguments.begin(), "limbcast-gateway");
  GatewayCommandLine command;
  Settings settings;
  settings.status = command.Parse(static_cast<int>(arguments.size()), arguments.data());
  if (settings.status) {
    return settings;
  }
  const Result<config::ConfigFile> file = command.LoadSettings();
  if (!file) {
    settings.read = file.error();
    return settings;
  }
  settings.gateway = ReadGatewayConfig(file->Get("gateway"));
  settings.replay = ReadReplayConfig(file->Get("replay"));
  settings.read = file->Finish();
  return settings;
}

TEST(GatewayCommandLineTest, WithoutOptionsAPersonIsSimulated) {
  const Settings settings = Parse({});
  ASSERT_TRUE(settings.read.ok());
  EXPECT_EQ(settings.gateway.driver, "simulator");
  EXPECT_EQ(settings.gateway.pace.speed, 1.0);
}

TEST(GatewayCommandLineTest, RecordingImpliesReplay) {
  const Settings settings =
      Parse({"--recording", "odd \"name\".csv", "--speed", "max", "--loop", "--wait-for", "posture",
             "--exit-at-end", "--person", "Ada", "--body-id", "3"});
  ASSERT_TRUE(settings.read.ok()) << settings.read.error().message;
  EXPECT_EQ(settings.gateway.driver, "replay");
  EXPECT_EQ(settings.replay.recording, "odd \"name\".csv");
  EXPECT_TRUE(settings.gateway.pace.as_fast);
  EXPECT_TRUE(settings.gateway.loop);
  EXPECT_TRUE(settings.gateway.exit_at_end);
  EXPECT_EQ(settings.gateway.wait_for, WaitFor::kPosture);
  EXPECT_EQ(settings.gateway.body_id, 3U);
  EXPECT_EQ(settings.replay.person, "Ada");
}

TEST(GatewayCommandLineTest, AssignmentsReachTheDriver) {
  const Settings settings =
      Parse({"--recording", "x", "--assign", "00B42279=pelvis", "--assign", "b=head"});
  ASSERT_TRUE(settings.read.ok()) << settings.read.error().message;
  ASSERT_EQ(settings.replay.options.assignments.size(), 2U);
  EXPECT_EQ(settings.replay.options.assignments[0].sensor, "00B42279");
  EXPECT_EQ(settings.replay.options.assignments[1].segment, "head");
}

TEST(GatewayCommandLineTest, MistakesEndWithStatusTwoOrNameThemselves) {
  EXPECT_EQ(Parse({"--spede", "3"}).status, 2);
  EXPECT_EQ(Parse({"--summary", "xml"}).status, 2);
  EXPECT_THAT(Parse({"--speed", "0"}).read.error().message,
              HasSubstr("gateway.speed must be in [0.01, 1000] or \"max\", is 0"));
  EXPECT_THAT(Parse({"--wait-for", "coffee"}).read.error().message, HasSubstr("gateway.wait_for"));
  EXPECT_EQ(Parse({"--assign", "pelvis"}).read.error().message,
            "--assign must be SENSOR=SEGMENT, is \"pelvis\"");
  EXPECT_THAT(Parse({"--recording", "x", "--assign", "a=tail"}).read.error().message,
              HasSubstr("'tail'"));
}

TEST(GatewayCommandLineTest, TomlStringsAreEscaped) {
  EXPECT_EQ(TomlString("a\\b\"c\n"), "\"a\\\\b\\\"c\\u000A\"");
}

}  // namespace
}  // namespace limbcast::gateway
