#include "services/gateway/drivers/replay/full_body_reader.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "services/gateway/drivers/replay/recording_reader.hpp"
#include "tests/support/shared_data.hpp"
#include "tests/unit/services/gateway/drivers/replay/recording_fixtures.hpp"

namespace limbcast::gateway {
namespace {

using ::testing::HasSubstr;

class FullBodyReaderTest : public ::testing::Test {
 protected:
  Result<Recording> Read(const std::vector<test::FixtureDataset>& datasets) {
    const std::filesystem::path path = folder_.path() / "walk.hdf5";
    test::WriteHdf5(path, datasets, 100.0);
    return ReadRecording(path);
  }
  test::TemporaryFolder folder_;
};

TEST_F(FullBodyReaderTest, OneTickHoldsAllSensors) {
  const Result<Recording> recording = Read(test::FullBodyDatasets(4));
  ASSERT_TRUE(recording.ok()) << recording.error().message;
  EXPECT_EQ(recording->format, "full_body");
  ASSERT_EQ(recording->ticks.size(), 4U);
  EXPECT_EQ(recording->ticks[1].marg_end, 8U);
  EXPECT_EQ(ToNanoseconds(recording->ticks[3].at), 30'000'000);
}

TEST_F(FullBodyReaderTest, MagnetometerIsFlaggedMissingNotFaked) {
  const Result<Recording> recording = Read(test::FullBodyDatasets(4));
  ASSERT_TRUE(recording.ok());
  for (const sensing::MargSample& sample : recording->marg) {
    EXPECT_TRUE(sample.Has(sensing::kMagMissing));
    EXPECT_TRUE(sample.mag_tesla.isZero());
  }
}

TEST_F(FullBodyReaderTest, GroupNamesBecomeSegments) {
  const Result<Recording> recording = Read(test::FullBodyDatasets(4));
  ASSERT_TRUE(recording.ok());
  ASSERT_EQ(recording->sensors.size(), 4U);                // in the order of the alphabet
  EXPECT_EQ(recording->sensors[0].segment, std::nullopt);  // gadget
  EXPECT_EQ(recording->sensors[1].segment, body::Segment::kL5);
  EXPECT_EQ(recording->sensors[2].segment, body::Segment::kPelvis);
  EXPECT_EQ(recording->sensors[3].segment, body::Segment::kRightForeArm);
}

TEST_F(FullBodyReaderTest, SensorWithoutGyroIsRefusedByName) {
  std::vector<test::FixtureDataset> datasets = test::FullBodyDatasets(4);
  datasets.pop_back();
  EXPECT_THAT(Read(datasets).error().message, HasSubstr("dataset /gadget/imu_gyr is missing"));
}

TEST_F(FullBodyReaderTest, TimeThatGoesBackIsRefusedWithItsRow) {
  std::vector<test::FixtureDataset> datasets = test::FullBodyDatasets(4);
  datasets[0].value = [](std::size_t row, std::size_t) {
    return row == 2 ? 0.0 : 1.0 + static_cast<double>(row);
  };
  EXPECT_THAT(Read(datasets).error().message, HasSubstr("/time must grow, does not at row 2"));
}

TEST_F(FullBodyReaderTest, OtherHdf5IsNoRecording) {
  const Result<Recording> recording = Read({test::FullBodyDatasets(4)[0]});
  ASSERT_FALSE(recording.ok());
  EXPECT_EQ(recording.error().code, ErrorCode::kUnsupported);
}

TEST_F(FullBodyReaderTest, ReadsTheRealRecording) {
  LIMBCAST_SKIP_WITHOUT_SHARED("data/fullbody/walking_fullbody.hdf5");
  const Result<Recording> recording =
      ReadRecording(*test_support::SharedPath("data/fullbody/walking_fullbody.hdf5"));
  ASSERT_TRUE(recording.ok()) << recording.error().message;
  EXPECT_EQ(recording->sensors.size(), 16U);
  for (const RecordedSensor& sensor : recording->sensors) {
    EXPECT_TRUE(sensor.segment.has_value()) << sensor.info.label;
  }
  EXPECT_EQ(recording->ticks.size(), 10000U);
  EXPECT_EQ(recording->marg.size(), 160000U);
  EXPECT_EQ(recording->duration(), DurationFromSeconds(99.99));
}

}  // namespace
}  // namespace limbcast::gateway
