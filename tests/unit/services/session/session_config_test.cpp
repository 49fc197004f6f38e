#include "services/session/session_config.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace limbcast::session {
namespace {

using namespace std::chrono_literals;
using ::testing::ElementsAre;
using ::testing::HasSubstr;

Result<SessionConfig> Read(std::string_view text) {
  const auto file = config::ConfigFile::Parse(text, "session.toml");
  if (!file) {
    return file.error();
  }
  const SessionConfig config = ReadSessionConfig(file->Get("session"));
  if (const Status read = file->Finish(); !read) {
    return read.error();
  }
  return config;
}

TEST(SessionConfigTest, DefaultsAreValid) {
  EXPECT_TRUE(Validate(SessionConfig{}).ok());
  EXPECT_TRUE(Validate(*Read("")).ok());
}

TEST(SessionConfigTest, ReadsEveryKey) {
  const auto config = Read(R"([session]
state_dir = "/var/lib/limbcast"
sessions = ["stage", "studio"]
allow_create = false
lease_s = 3
grace_s = 60
max_sessions = 4
max_members = 100
max_members_of_client = 10
max_remembered = 50
new_members_per_s = 20
max_refusals_per_s = 7
[session.coil]
pulse_s = 0.01
clock_error_s = 0.0001
free_running_hz = 100
burst_rate_hz = 1
)");
  ASSERT_TRUE(config.ok()) << config.error().message;
  EXPECT_EQ(config->state_dir, "/var/lib/limbcast");
  EXPECT_THAT(config->sessions, ElementsAre("stage", "studio"));
  EXPECT_FALSE(config->allow_create);
  EXPECT_EQ(config->limits.lease, 3s);
  EXPECT_EQ(config->limits.grace, 60s);
  EXPECT_EQ(config->limits.max_sessions, 4U);
  EXPECT_EQ(config->limits.max_members, 100U);
  EXPECT_EQ(config->limits.max_members_of_client, 10U);
  EXPECT_EQ(config->limits.max_remembered, 50U);
  EXPECT_DOUBLE_EQ(config->limits.new_members_per_s, 20.0);
  EXPECT_EQ(config->max_refusals_per_s, 7U);
  EXPECT_EQ(config->limits.coil_slots,
            static_cast<std::uint32_t>(sensing::PlanCoilSlots(config->coil).users));
  EXPECT_GT(config->limits.coil_slots, 5U);
}

TEST(SessionConfigTest, WhatIsOutOfRangeIsNamed) {
  EXPECT_THAT(Read("[session]\nlease_s = 0.1").error().message,
              HasSubstr("session.toml:2: session.lease_s must be in [1, 60], is 0.1"));
  EXPECT_THAT(Read("[session]\nsessions = [\"a*\"]").error().message,
              HasSubstr("session.sessions has \"a*\""));
  EXPECT_THAT(Read("[session]\nlease = 1").error().message, HasSubstr("session.lease"));
  SessionConfig many;
  many.limits.max_sessions = 1;
  many.sessions = {"a", "b"};
  EXPECT_THAT(Validate(many).error().message, HasSubstr("session.max_sessions = 1, is 2"));
}

TEST(SessionConfigTest, TheShippedFileSaysTheDefaults) {
  const auto file = config::ConfigFile::Load(LIMBCAST_SOURCE_DIR "/deploy/config/session.toml");
  ASSERT_TRUE(file.ok()) << file.error().message;
  const SessionConfig shipped = ReadSessionConfig(file->Get("session"));
  for (const std::string& key : file->Get("bus").Keys()) {
    (void)file->Get("bus").ReadAnyAsText(key);  // read by common/service
  }
  ASSERT_TRUE(file->Finish().ok()) << file->Finish().error().message;
  const SessionConfig defaults = *Read("");
  EXPECT_EQ(shipped.limits.lease, defaults.limits.lease);
  EXPECT_EQ(shipped.limits.grace, defaults.limits.grace);
  EXPECT_EQ(shipped.limits.max_sessions, defaults.limits.max_sessions);
  EXPECT_EQ(shipped.limits.max_members, defaults.limits.max_members);
  EXPECT_EQ(shipped.limits.max_members_of_client, defaults.limits.max_members_of_client);
  EXPECT_EQ(shipped.limits.max_remembered, defaults.limits.max_remembered);
  EXPECT_EQ(shipped.limits.coil_slots, defaults.limits.coil_slots);
  EXPECT_DOUBLE_EQ(shipped.limits.new_members_per_s, defaults.limits.new_members_per_s);
  EXPECT_EQ(shipped.max_refusals_per_s, defaults.max_refusals_per_s);
  EXPECT_EQ(shipped.allow_create, defaults.allow_create);
}

}  // namespace
}  // namespace limbcast::session
