// What a fusion service knows of its sensors when it is started again: with and without its file,
// and with a file that is not its own.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <numbers>
#include <string>

#include "common/math/angles.hpp"
#include "tests/support/temporary_folder.hpp"
#include "tests/unit/services/fusion/fusion_fixture.hpp"

namespace limbcast::fusion {
namespace {

using ::testing::HasSubstr;

constexpr std::uint64_t kSensor = 10;
constexpr int kStartSamples = 105;  // a start takes a second; rest is noticed later

// One head with a sensor without magnetometer, whose gyro is wrong by a bias.
class FilterRestartTest : public ::testing::Test {
 protected:
  FilterRestartTest() {
    config_.state_dir = folder_.path().string();
    config_.state_period_s = 3600.0;  // only at the end
    world_.Assign(1, {{kSensor, body::Segment::kHead}});
  }

  struct Running {
    Running(const FusionConfig& config, FusionWorld& world)
        : service(config, world.clock, *world.inside, pool) {
      EXPECT_TRUE(service.Start().ok());
    }
    ~Running() { service.Stop(); }
    [[nodiscard]] ServiceHealth Health() {
      ServiceHealth health;
      service.FillHealth(health);
      return health;
    }
    test_support::ImmediatePool pool;
    FusionService service;
  };

  // 10 ms each, turning about the vertical.
  void Turn(int samples, double rate_rad_s) {
    for (int i = 0; i < samples; ++i) {
      sensing::MargSample sample = world_.Sample(kSensor, ++sequence_);
      sample.flags |= sensing::MargFlag::kMagMissing;
      sample.gyro_rad_s = kBias_rad_s + Eigen::Vector3f(0.0F, 0.0F, static_cast<float>(rate_rad_s));
      sample.accel_m_s2 = {0.0F, 0.0F, 9.80665F};
      world_.Send(sample);
    }
  }
  // A service learns the bias at rest, turns a quarter to the left, and ends; 8 s pass.
  void LearnAndTurn() {
    Running running(config_, world_);
    Turn(2000, 0.0);
    Turn(100, std::numbers::pi / 2.0);
    Turn(100, 0.0);
    ASSERT_NEAR(Heading_deg(), 90.0, 2.0);
    sequence_ += 800;
  }
  [[nodiscard]] double Heading_deg() const {
    return math::Heading_rad(world_.last().q_earth_sensor) * 180.0 / std::numbers::pi;
  }
  [[nodiscard]] float Rate_rad_s() const {
    return world_.last().w_earth_sensor_in_sensor_rad_s.norm();
  }
  [[nodiscard]] std::filesystem::path File() const { return folder_ / "filters.state"; }

  const Eigen::Vector3f kBias_rad_s{0.02F, -0.01F, 0.02F};
  const test_support::TemporaryFolder folder_;
  FusionWorld world_;
  FusionConfig config_;
  std::uint32_t sequence_ = 0;
};

TEST_F(FilterRestartTest, GoesOnWithHeadingAndBias) {
  LearnAndTurn();
  Running again(config_, world_);
  Turn(1, 0.0);
  EXPECT_NEAR(Heading_deg(), 90.0, 2.0) << "shown at once";
  Turn(kStartSamples, 0.0);
  EXPECT_TRUE(world_.last().started);
  EXPECT_NEAR(Heading_deg(), 90.0, 2.0);
  EXPECT_LT(Rate_rad_s(), 2e-3F);
  EXPECT_EQ(again.service.counters().restored, 1U);
}

TEST_F(FilterRestartTest, WithoutAFolderBeginsAnew) {
  config_.state_dir.clear();
  LearnAndTurn();
  Running again(config_, world_);
  Turn(kStartSamples, 0.0);
  EXPECT_TRUE(world_.last().started);
  EXPECT_NEAR(Heading_deg(), 0.0, 3.0);
  EXPECT_GT(Rate_rad_s(), 1e-2F);
  EXPECT_EQ(again.service.counters().restored, 0U);
}

TEST_F(FilterRestartTest, StatesOfOtherSettingsOrTooOldAreLeftAlone) {
  LearnAndTurn();
  const FusionConfig kept = config_;
  config_.state_max_age_s = 60.0;
  world_.clock.Advance(std::chrono::seconds(61));
  {
    Running again(config_, world_);
    EXPECT_EQ(again.service.counters().restored, 0U) << "too old";
    EXPECT_EQ(again.Health().last_error, "");
  }
  config_ = kept;
  config_.filter_settings["bmf"] = {{"slow_rate_hz", "10"}};
  {
    Running again(config_, world_);
    EXPECT_EQ(again.service.counters().restored, 0U) << "other settings";
  }
  config_.filter.name = "tqt";  // writes its own over it
  { Running again(config_, world_); }
  config_.filter.name = "bmf";
  Running again(config_, world_);
  EXPECT_EQ(again.service.counters().restored, 0U) << "another filter";
}

TEST_F(FilterRestartTest, DamagedFileIsRefusedAndKeptAndTheServiceRuns) {
  LearnAndTurn();
  std::filesystem::resize_file(File(), std::filesystem::file_size(File()) - 1);
  {
    Running again(config_, world_);
    EXPECT_THAT(again.Health().last_error, HasSubstr("filters.state: damaged or cut off"));
    Turn(kStartSamples, 0.0);
    EXPECT_TRUE(world_.last().started);
    EXPECT_NEAR(Heading_deg(), 0.0, 3.0);
  }
  EXPECT_TRUE(std::filesystem::exists(File().string() + ".refused"));
  EXPECT_TRUE(std::filesystem::exists(File())) << "its own at the end";
}

TEST_F(FilterRestartTest, FolderThatCannotBeWrittenIsRefusedAtTheStart) {
  config_.state_dir = "/proc/no/such";
  test_support::ImmediatePool pool;
  FusionService service(config_, world_.clock, *world_.inside, pool);
  const Status started = service.Start();
  ASSERT_FALSE(started.ok());
  EXPECT_THAT(started.error().message, HasSubstr("fusion.state_dir"));
}

TEST_F(FilterRestartTest, FolderThatVanishesIsCountedAndNothingElseSuffers) {
  Running running(config_, world_);
  Turn(50, 0.0);
  std::filesystem::remove_all(folder_.path());
  running.service.Stop();
  const ServiceHealth health = running.Health();
  EXPECT_THAT(health.last_error, HasSubstr("filters.state"));
  const auto errors = std::find_if(health.values.begin(), health.values.end(), [](const auto& one) {
    return one.name == "filters.save_errors";
  });
  ASSERT_NE(errors, health.values.end());
  EXPECT_EQ(errors->value, 1.0);
}

}  // namespace
}  // namespace limbcast::fusion
