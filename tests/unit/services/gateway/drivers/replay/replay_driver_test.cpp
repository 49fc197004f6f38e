#include "services/gateway/drivers/replay/replay_driver.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/unit/services/gateway/drivers/replay/recording_fixtures.hpp"

namespace limbcast::gateway {
namespace {

using ::testing::HasSubstr;

class ReplayDriverTest : public ::testing::Test {
 protected:
  std::unique_ptr<ReplayDriver> Make(const std::vector<test::FixtureDataset>& datasets) {
    const std::filesystem::path path = folder_.path() / "walk.hdf5";
    test::WriteHdf5(path, datasets, 100.0);
    Result<std::unique_ptr<ReplayDriver>> driver =
        ReplayDriver::Make({.recording = path, .person = "", .options = {}});
    Expects(driver.ok(), "a readable fixture");
    return std::move(*driver);
  }
  test::TemporaryFolder folder_;
};

TEST_F(ReplayDriverTest, DescribesThePersonAndLeavesUnassignedSensorsOut) {
  const auto driver = Make(test::FullBodyDatasets(3));
  const DriverDescription& description = driver->Describe();
  EXPECT_EQ(description.driver, "replay");
  EXPECT_EQ(description.sensors.size(), 4U);
  ASSERT_EQ(description.bodies.size(), 1U);
  EXPECT_EQ(description.bodies[0].sensors.size(), 3U);  // gadget is on no segment
  EXPECT_EQ(description.bodies[0].person, "walk");
  EXPECT_EQ(description.tick_rate_hz, 100.0);
  EXPECT_FALSE(description.has_truth);
}

TEST_F(ReplayDriverTest, GivesEveryTickOnceThenTheEnd) {
  const auto driver = Make(test::BroadDatasets(3));
  Batch batch;
  for (int tick = 0; tick < 3; ++tick) {
    ASSERT_EQ(*driver->Next(batch), DriverStep::kData);
    EXPECT_EQ(ToNanoseconds(batch.tick_at), tick * 10'000'000);
    ASSERT_EQ(batch.marg.size(), 1U);
    EXPECT_EQ(batch.marg[0].gyro_rad_s.x(), static_cast<float>(tick));
    EXPECT_EQ(batch.truth.size(), 1U);
    EXPECT_EQ(batch.truth[0].body_id, BodyId{1});
  }
  EXPECT_EQ(*driver->Next(batch), DriverStep::kEnd);
  EXPECT_TRUE(batch.marg.empty());
}

TEST_F(ReplayDriverTest, RewindStartsAtTheFirstTickAgain) {
  const auto driver = Make(test::BroadDatasets(2));
  Batch batch;
  while (*driver->Next(batch) == DriverStep::kData) {
  }
  ASSERT_TRUE(driver->Rewind().ok());
  ASSERT_EQ(*driver->Next(batch), DriverStep::kData);
  EXPECT_EQ(batch.tick_at, Time{});
}

TEST_F(ReplayDriverTest, ConfigurationNamesAnUnknownSegment) {
  const Result<config::ConfigFile> file = config::ConfigFile::Parse(
      "[replay]\nrecording = \"x\"\n[[replay.assign]]\nsensor = \"a\"\nsegment = \"tail\"\n", "c");
  ASSERT_TRUE(file.ok());
  static_cast<void>(ReadReplayConfig(file->Get("replay")));
  EXPECT_THAT(file->Finish().error().message, HasSubstr("'tail'"));
}

TEST_F(ReplayDriverTest, ConfigurationReachesTheOptions) {
  const Result<config::ConfigFile> file = config::ConfigFile::Parse(
      "[replay]\nrecording = \"x\"\nperson = \"Ada\"\ngyro_range_rad_s = 34.9\n"
      "[[replay.assign]]\nsensor = \"a\"\nsegment = \"head\"\n",
      "c");
  ASSERT_TRUE(file.ok());
  const ReplayConfig config = ReadReplayConfig(file->Get("replay"));
  ASSERT_TRUE(file->Finish().ok()) << file->Finish().error().message;
  EXPECT_EQ(config.recording, "x");
  EXPECT_EQ(config.person, "Ada");
  EXPECT_EQ(config.options.gyro_range_rad_s, 34.9);
  ASSERT_EQ(config.options.assignments.size(), 1U);
  EXPECT_EQ(config.options.assignments[0].segment, "head");
}

TEST_F(ReplayDriverTest, UnreadableRecordingIsAnError) {
  EXPECT_EQ(ReplayDriver::Make({.recording = folder_.path() / "none", .person = "", .options = {}})
                .error()
                .code,
            ErrorCode::kNotFound);
}

}  // namespace
}  // namespace limbcast::gateway
