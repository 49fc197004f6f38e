#include "services/posture/posture_config.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "common/service/service_command_line.hpp"

namespace limbcast::posture {
namespace {

using ::testing::HasSubstr;

Result<PostureConfig> Read(std::string_view text) {
  const auto file = config::ConfigFile::Parse(text, "posture.toml");
  if (!file) {
    return file.error();
  }
  const PostureConfig config = ReadPostureConfig(file->Get("posture"));
  if (const Status read = file->Finish(); !read) {
    return read.error();
  }
  return config;
}

TEST(PostureConfigTest, DefaultsAreValid) {
  EXPECT_TRUE(Validate({}).ok());
  EXPECT_TRUE(Validate(*Read("")).ok());
}

TEST(PostureConfigTest, ReadsEveryKey) {
  const auto config = Read(R"([posture]
workers = 3
tick_deadline_s = 0.005
output_rate_hz = 90
max_extrapolation_s = 0.02
missing_after_s = 1.5
still_window_s = 0.5
still_limit_rad = 0.1
body_height_m = 1.6
segments = ["pelvis", "t8"]
joint_limits = true
joint_softness_rad = 0.2
contacts = false
joint_angles = false
state_dir = "/var/lib/limbcast"
)");
  ASSERT_TRUE(config.ok()) << config.error().message;
  EXPECT_EQ(config->workers, 3U);
  EXPECT_DOUBLE_EQ(config->tick_deadline_s, 0.005);
  EXPECT_DOUBLE_EQ(config->output_rate_hz, 90.0);
  EXPECT_DOUBLE_EQ(config->max_extrapolation_s, 0.02);
  EXPECT_DOUBLE_EQ(config->missing_after_s, 1.5);
  EXPECT_DOUBLE_EQ(config->still_window_s, 0.5);
  EXPECT_DOUBLE_EQ(config->still_limit_rad, 0.1);
  EXPECT_DOUBLE_EQ(config->body_height_m, 1.6);
  EXPECT_EQ(config->segments.size(), 2U);
  EXPECT_TRUE(config->joint_limits);
  EXPECT_DOUBLE_EQ(config->joint_softness_rad, 0.2);
  EXPECT_FALSE(config->contacts);
  EXPECT_FALSE(config->joint_angles);
  EXPECT_EQ(config->state_dir, "/var/lib/limbcast");
}

TEST(PostureConfigTest, RefusalsNameKeyValueAndLimit) {
  const auto message = [](std::string_view text) {
    const auto config = Read(text);
    return config.ok() ? std::string() : config.error().message;
  };
  EXPECT_THAT(message("[posture]\nworkers = 0"), HasSubstr("posture.workers must be in [1, 64]"));
  EXPECT_THAT(message("[posture]\noutput_rate_hz = 0.5"),
              HasSubstr("posture.output_rate_hz must be 0 or in [1, 1000], is 0.5"));
  EXPECT_THAT(message("[posture]\nsegments = [\"tail\"]"), HasSubstr("has 'tail'"));
  EXPECT_THAT(message("[posture]\nno_such_key = 1"), HasSubstr("no_such_key"));
}

TEST(PostureConfigTest, ValidateChecksWhatCodeSets) {
  PostureConfig config;
  config.tick_deadline_s = 0.0;
  EXPECT_THAT(Validate(config).error().message, HasSubstr("posture.tick_deadline_s"));
  config = {};
  config.output_rate_hz = 0.5;
  EXPECT_FALSE(Validate(config).ok());
}

TEST(PostureConfigTest, TheShippedFileSaysTheDefaults) {
  const auto file =
      config::ConfigFile::Load(std::string(LIMBCAST_SOURCE_DIR) + "/deploy/config/posture.toml");
  ASSERT_TRUE(file.ok()) << file.error().message;
  const PostureConfig shipped = ReadPostureConfig(file->Get("posture"));
  (void)service::ReadBusConfig(file->Get("bus"));
  EXPECT_TRUE(file->Finish().ok()) << file->Finish().error().message;
  const PostureConfig defaults;
  EXPECT_EQ(shipped.workers, defaults.workers);
  EXPECT_EQ(shipped.tick_deadline_s, defaults.tick_deadline_s);
  EXPECT_EQ(shipped.output_rate_hz, defaults.output_rate_hz);
  EXPECT_EQ(shipped.max_extrapolation_s, defaults.max_extrapolation_s);
  EXPECT_EQ(shipped.missing_after_s, defaults.missing_after_s);
  EXPECT_EQ(shipped.still_window_s, defaults.still_window_s);
  EXPECT_EQ(shipped.still_limit_rad, defaults.still_limit_rad);
  EXPECT_EQ(shipped.body_height_m, defaults.body_height_m);
  EXPECT_EQ(shipped.segments, defaults.segments);
  EXPECT_EQ(shipped.joint_limits, defaults.joint_limits);
  EXPECT_EQ(shipped.joint_softness_rad, defaults.joint_softness_rad);
  EXPECT_EQ(shipped.contacts, defaults.contacts);
  EXPECT_EQ(shipped.joint_angles, defaults.joint_angles);
  EXPECT_EQ(shipped.state_dir, defaults.state_dir);
}

}  // namespace
}  // namespace limbcast::posture
