#include "services/posture/posture_config.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

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
  EXPECT_THAT(message("[posture]\nsegments = [\"tail\"]"), HasSubstr("has \"tail\""));
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

}  // namespace
}  // namespace limbcast::posture
