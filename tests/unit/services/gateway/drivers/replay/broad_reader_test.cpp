#include "services/gateway/drivers/replay/broad_reader.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "services/gateway/drivers/replay/recording_reader.hpp"
#include "tests/support/shared_data.hpp"
#include "tests/unit/services/gateway/drivers/replay/recording_fixtures.hpp"

namespace limbcast::gateway {
namespace {

using ::testing::HasSubstr;

class BroadReaderTest : public ::testing::Test {
 protected:
  Result<Recording> Read(const std::vector<test::FixtureDataset>& datasets) {
    const std::filesystem::path path = folder_.path() / "trial.hdf5";
    test::WriteHdf5(path, datasets, 250.0);
    return ReadRecording(path);
  }
  test::TemporaryFolder folder_;
};

TEST_F(BroadReaderTest, ConvertsToOurUnitsAndTimes) {
  const Result<Recording> recording = Read(test::BroadDatasets(6));
  ASSERT_TRUE(recording.ok()) << recording.error().message;
  EXPECT_EQ(recording->format, "broad");
  ASSERT_EQ(recording->marg.size(), 6U);
  const sensing::MargSample& sample = recording->marg[4];
  EXPECT_EQ(ToNanoseconds(sample.measured_at), 16'000'000);  // 4 rows at 250 Hz
  EXPECT_EQ(sample.gyro_rad_s, Eigen::Vector3f(4.0F, 0.0F, 0.0F));
  EXPECT_EQ(sample.accel_m_s2, Eigen::Vector3f(0.0F, 0.0F, 9.81F));
  EXPECT_TRUE(sample.mag_tesla.isApprox(Eigen::Vector3f(20e-6F, 0.0F, -2e-6F), 1e-6F));
  EXPECT_EQ(recording->sensors[0].segment, body::Segment::kPelvis);
  EXPECT_EQ(recording->ticks.size(), 6U);
}

TEST_F(BroadReaderTest, FlagsRepeatedMagnetometerReadings) {
  const Result<Recording> recording = Read(test::BroadDatasets(6));
  ASSERT_TRUE(recording.ok());
  for (std::size_t row = 0; row < 6; ++row) {
    EXPECT_EQ(recording->marg[row].Has(sensing::kMagHeld), row % 2 == 1) << "row " << row;
    EXPECT_FALSE(recording->marg[row].Has(sensing::kMagMissing));
  }
}

TEST_F(BroadReaderTest, TruthIsCanonicalAndInvalidWhereTheMarkersWereNotSeen) {
  const Result<Recording> recording = Read(test::BroadDatasets(6));
  ASSERT_TRUE(recording.ok());
  for (std::size_t row = 0; row < 6; ++row) {
    const body::SegmentTruth& truth = recording->truth[row];
    EXPECT_EQ(truth.sensor_valid, row != 2);
    EXPECT_EQ(truth.segment_valid, row != 2);
    EXPECT_EQ(truth.q_earth_sensor.w(), 1.0);  // -1 in the file
    EXPECT_EQ(recording->movement[row], row >= 3 ? 1 : 0);
  }
  EXPECT_EQ(recording->truth[0].p_earth_segment_m.z(), 1.5);
}

TEST_F(BroadReaderTest, MissingDatasetIsNamed) {
  std::vector<test::FixtureDataset> datasets = test::BroadDatasets(6);
  datasets.erase(datasets.begin() + 3);
  EXPECT_THAT(Read(datasets).error().message, HasSubstr("dataset /opt_quat is missing"));
}

TEST_F(BroadReaderTest, DatasetsOfDifferentLengthAreRefused) {
  std::vector<test::FixtureDataset> datasets = test::BroadDatasets(6);
  datasets[1].rows = 5;
  EXPECT_THAT(Read(datasets).error().message, HasSubstr("/imu_acc has 5 rows, /imu_gyr has 6"));
}

TEST_F(BroadReaderTest, NotFiniteReadingsGoThroughUntouched) {
  std::vector<test::FixtureDataset> datasets = test::BroadDatasets(6);
  datasets[0].value = [](std::size_t row, std::size_t) { return row == 3 ? std::nan("") : 0.0; };
  const Result<Recording> recording = Read(datasets);
  ASSERT_TRUE(recording.ok());
  EXPECT_TRUE(std::isnan(recording->marg[3].gyro_rad_s.x()));
  EXPECT_EQ(recording->marg[3].flags & sensing::kGyroMissing, 0U);
}

// Rows and rate as the files' README states them: duration 204 s at 2000/7 Hz.
TEST_F(BroadReaderTest, ReadsARealTrial) {
  LIMBCAST_SKIP_WITHOUT_SHARED("data/broad/03_undisturbed_slow_rotation_C.hdf5");
  const Result<Recording> recording =
      ReadRecording(*test_support::SharedPath("data/broad/03_undisturbed_slow_rotation_C.hdf5"));
  ASSERT_TRUE(recording.ok()) << recording.error().message;
  EXPECT_EQ(recording->marg.size(), 58412U);
  EXPECT_EQ(recording->truth.size(), 58412U);
  EXPECT_NEAR(ToSeconds(recording->duration()), 204.0, 1.0);
  // New magnetometer values come 5 times in 7 samples.
  std::size_t held = 0;
  for (const sensing::MargSample& sample : recording->marg) {
    held += sample.Has(sensing::kMagHeld) ? 1U : 0U;
  }
  EXPECT_NEAR(static_cast<double>(held) / 58412.0, 2.0 / 7.0, 0.01);
}

}  // namespace
}  // namespace limbcast::gateway
