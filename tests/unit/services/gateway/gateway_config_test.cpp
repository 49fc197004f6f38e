#include "services/gateway/gateway_config.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "common/service/service_command_line.hpp"
#include "services/gateway/driver_factory.hpp"

namespace limbcast::gateway {
namespace {

using ::testing::HasSubstr;

struct ReadBack {
  GatewayConfig config;
  Status status;
};

ReadBack Read(const std::string& lines) {
  const Result<config::ConfigFile> file =
      config::ConfigFile::Parse("[gateway]\n" + lines, "g.toml");
  Expects(file.ok(), "a file that parses");
  ReadBack read;
  read.config = ReadGatewayConfig(file->Get("gateway"));
  read.status = file->Finish();
  return read;
}

TEST(GatewayConfigTest, DefaultsAreValid) { EXPECT_TRUE(Validate(GatewayConfig{}).ok()); }

TEST(GatewayConfigTest, EveryKeyIsRead) {
  const ReadBack read = Read(
      "driver = \"replay\"\nspeed = 2.5\nloop = true\nexit_at_end = true\nmarg_frame = true\n"
      "gateway_id = 7\ncalibration_folder = \"cal\"\npublish_roster = false\npublish_truth = "
      "false\nsession = \"s\"\nsession_host = true\nperson = \"Ada\"\n"
      "body_id = 3\nwait_for = \"posture\"\nwait_timeout_s = 5\nwait_timeout_action = \"exit\"\n"
      "window_ticks = 4\nanswer_timeout_s = 0.5\nlinger_s = 0\n");
  ASSERT_TRUE(read.status.ok()) << read.status.error().message;
  EXPECT_EQ(read.config.driver, "replay");
  EXPECT_EQ(read.config.pace.speed, 2.5);
  EXPECT_TRUE(read.config.loop);
  EXPECT_TRUE(read.config.exit_at_end);
  EXPECT_TRUE(read.config.marg_frame);
  EXPECT_EQ(read.config.gateway_id, 7U);
  EXPECT_EQ(read.config.calibration_folder, "cal");
  EXPECT_FALSE(read.config.publish_roster);
  EXPECT_FALSE(read.config.publish_truth);
  EXPECT_EQ(read.config.session, "s");
  EXPECT_TRUE(read.config.session_host);
  EXPECT_EQ(read.config.person, "Ada");
  GatewayConfig nowhere;
  nowhere.session_host = true;
  EXPECT_EQ(Validate(nowhere).error().message,
            "gateway.session must name a session when gateway.session_host is true");
  EXPECT_EQ(read.config.body_id, 3U);
  EXPECT_EQ(read.config.wait_for, WaitFor::kPosture);
  EXPECT_EQ(read.config.wait_timeout_s, 5.0);
  EXPECT_TRUE(read.config.exit_on_wait_timeout);
  EXPECT_EQ(read.config.window_ticks, 4U);
  EXPECT_EQ(read.config.answer_timeout_s, 0.5);
  EXPECT_EQ(read.config.linger_s, 0.0);
}

TEST(GatewayConfigTest, SpeedIsAFactorOrMax) {
  EXPECT_TRUE(Read("speed = \"max\"\n").config.pace.as_fast);
  EXPECT_EQ(Read("speed = 3\n").config.pace.speed, 3.0);
  EXPECT_THAT(Read("speed = 0\n").status.error().message,
              HasSubstr("g.toml:2: gateway.speed must be in [0.01, 1000] or \"max\", is 0"));
  EXPECT_THAT(Read("speed = \"fast\"\n").status.error().message, HasSubstr("is fast"));
}

TEST(GatewayConfigTest, RefusalsNameKeyValueAndLimit) {
  EXPECT_THAT(Read("window_ticks = 0\n").status.error().message,
              HasSubstr("gateway.window_ticks must be in [1, 1024], is 0"));
  EXPECT_THAT(Read("wait_for = \"coffee\"\n").status.error().message,
              HasSubstr("gateway.wait_for"));
  EXPECT_THAT(Read("spede = 1\n").status.error().message, HasSubstr("gateway.spede"));
  GatewayConfig config;
  config.linger_s = -1.0;
  EXPECT_THAT(Validate(config).error().message, HasSubstr("gateway.linger_s must be in [0"));
}

TEST(GatewayConfigTest, ShippedFileSaysTheDefaults) {
  const Result<config::ConfigFile> file =
      config::ConfigFile::Load(LIMBCAST_SOURCE_DIR "/deploy/config/gateway.toml");
  ASSERT_TRUE(file.ok()) << file.error().message;
  const GatewayConfig config = ReadGatewayConfig(file->Get("gateway"));
  const DriverConfigs drivers = ReadDriverConfigs(*file);
  static_cast<void>(service::ReadBusConfig(file->Get("bus")));
  EXPECT_TRUE(file->Finish().ok()) << file->Finish().error().message;
  EXPECT_TRUE(MakeDriver(config.driver, drivers).ok());
  const GatewayConfig defaults;
  EXPECT_EQ(config.driver, defaults.driver);
  EXPECT_EQ(config.pace.speed, defaults.pace.speed);
  EXPECT_EQ(config.wait_for, defaults.wait_for);
  EXPECT_EQ(config.wait_timeout_s, defaults.wait_timeout_s);
  EXPECT_EQ(config.window_ticks, defaults.window_ticks);
  EXPECT_EQ(config.answer_timeout_s, defaults.answer_timeout_s);
  EXPECT_EQ(config.linger_s, defaults.linger_s);
}

}  // namespace
}  // namespace limbcast::gateway
