#include "services/gateway/drivers/replay/csv_reader.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <string>

namespace limbcast::gateway {
namespace {

using ::testing::HasSubstr;

constexpr std::string_view kHeader =
    "time_s,sensor,gyro_x_rad_s,gyro_y_rad_s,gyro_z_rad_s,accel_x_m_s2,accel_y_m_s2,accel_z_m_s2,"
    "mag_x_tesla,mag_y_tesla,mag_z_tesla\n";

Result<Recording> Read(const std::string& text) { return ReadCsv(text, "f.csv", "f", {}); }
Result<Recording> ReadRows(const std::string& rows) { return Read(std::string(kHeader) + rows); }

TEST(CsvReaderTest, ReadsSamplesOfSeveralSensors) {
  const Result<Recording> recording = ReadRows(
      "# a comment\n"
      "100.00,pelvis,1,2,3,0,0,9.81,2e-5,0,-4e-5\r\n"
      "100.00,head,4,5,6,0,0,9.81,,,\n"
      "\n"
      "100.01,pelvis,1,2,3,0,0,9.81,2e-5,0,-4e-5\n");
  ASSERT_TRUE(recording.ok()) << recording.error().message;
  ASSERT_EQ(recording->marg.size(), 3U);
  EXPECT_EQ(recording->ticks.size(), 2U);
  EXPECT_EQ(ToNanoseconds(recording->ticks[0].at), 0);
  EXPECT_EQ(ToNanoseconds(recording->ticks[1].at), 10'000'000);
  EXPECT_NEAR(recording->rate_hz, 100.0, 1e-6);
  EXPECT_EQ(recording->marg[0].gyro_rad_s, Eigen::Vector3f(1.0F, 2.0F, 3.0F));
  EXPECT_EQ(recording->sensors[1].segment, body::Segment::kHead);
}

TEST(CsvReaderTest, EmptyVectorIsFlaggedMissing) {
  const Result<Recording> recording = ReadRows("0,a,1,2,3,,,,,,\n");
  ASSERT_TRUE(recording.ok());
  const sensing::MargSample& sample = recording->marg[0];
  EXPECT_TRUE(sample.Has(sensing::kMagMissing));
  EXPECT_TRUE(sample.Has(sensing::kAccelMissing));
  EXPECT_FALSE(sample.Has(sensing::kGyroMissing));
  EXPECT_TRUE(sample.Has(sensing::kTemperatureMissing));
}

TEST(CsvReaderTest, WrongUnitNamesColumnAndExpectation) {
  EXPECT_EQ(Read("time_s,sensor,gyro_x_deg_s,gyro_y_deg_s,gyro_z_deg_s\n").error().message,
            "f.csv:1: column 'gyro_x_deg_s': wrong unit, expected 'gyro_x_rad_s'");
  EXPECT_EQ(Read("time_ms,sensor\n").error().message,
            "f.csv:1: column 'time_ms': wrong unit, expected 'time_s'");
  EXPECT_EQ(Read("time_s,sensor,accel_x\n").error().message,
            "f.csv:1: column 'accel_x': wrong unit, expected 'accel_x_m_s2'");
}

TEST(CsvReaderTest, UnknownDoubleMissingAndIncompleteColumnsAreNamed) {
  EXPECT_THAT(Read("time_s,sensor,pressure_pa\n").error().message,
              HasSubstr("column 'pressure_pa': unknown"));
  EXPECT_THAT(Read("time_s,time_s\n").error().message, HasSubstr("column 'time_s': stands twice"));
  EXPECT_THAT(Read("time_s,gyro_x_rad_s\n").error().message,
              HasSubstr("column 'sensor': is missing"));
  EXPECT_THAT(Read("time_s,sensor,gyro_x_rad_s,gyro_y_rad_s\n").error().message,
              HasSubstr("column 'gyro_z_rad_s': is missing"));
  EXPECT_THAT(Read("# nothing\n").error().message, HasSubstr("no line of column names"));
}

TEST(CsvReaderTest, BadCellsAreRefusedWithLineAndColumn) {
  EXPECT_EQ(ReadRows("0,a,1,2,3,x,0,9.81,,,\n").error().message,
            "f.csv:2: column 'accel_x_m_s2': 'x' is no number");
  EXPECT_THAT(ReadRows("0,a,1,2,,0,0,9.81,,,\n").error().message,
              HasSubstr("f.csv:2: column 'gyro_x_rad_s': some of the vector's cells are empty"));
  EXPECT_THAT(ReadRows("0,a,1,2\n").error().message,
              HasSubstr("f.csv:2: has 4 cells, expected 11"));
  EXPECT_THAT(ReadRows("nan,a,1,2,3,0,0,9.81,,,\n").error().message,
              HasSubstr("f.csv:2: column 'time_s'"));
  EXPECT_THAT(ReadRows("0,,1,2,3,0,0,9.81,,,\n").error().message,
              HasSubstr("f.csv:2: column 'sensor'"));
}

TEST(CsvReaderTest, NotFiniteReadingsGoThroughUntouched) {
  const Result<Recording> recording = ReadRows("0,a,nan,inf,-inf,0,0,9.81,,,\n");
  ASSERT_TRUE(recording.ok()) << recording.error().message;
  EXPECT_TRUE(std::isnan(recording->marg[0].gyro_rad_s.x()));
  EXPECT_TRUE(std::isinf(recording->marg[0].gyro_rad_s.y()));
  EXPECT_FALSE(recording->marg[0].Has(sensing::kGyroMissing));
}

TEST(CsvReaderTest, RowsOutOfOrderKeepTheirPlaceAndTheirTime) {
  const Result<Recording> recording = ReadRows(
      "0.00,a,0,0,0,0,0,9.81,,,\n"
      "0.02,a,2,0,0,0,0,9.81,,,\n"
      "0.01,a,1,0,0,0,0,9.81,,,\n"
      "0.03,a,3,0,0,0,0,9.81,,,\n");
  ASSERT_TRUE(recording.ok());
  EXPECT_EQ(recording->out_of_order, 1U);
  ASSERT_EQ(recording->ticks.size(), 3U);
  EXPECT_EQ(recording->marg[2].gyro_rad_s.x(), 1.0F);
  EXPECT_EQ(ToNanoseconds(recording->marg[2].measured_at), 10'000'000);
  EXPECT_EQ(ToNanoseconds(recording->ticks[1].at), 20'000'000);
  EXPECT_EQ(recording->ticks[1].marg_end, 3U);
}

TEST(CsvReaderTest, SensorBySensorFilesAreMergedByTime) {
  const Result<Recording> recording = ReadRows(
      "0.00,a,0,0,0,0,0,9.81,,,\n"
      "0.01,a,0,0,0,0,0,9.81,,,\n"
      "0.00,b,0,0,0,0,0,9.81,,,\n"
      "0.01,b,0,0,0,0,0,9.81,,,\n");
  ASSERT_TRUE(recording.ok());
  EXPECT_EQ(recording->out_of_order, 0U);
  EXPECT_EQ(recording->ticks.size(), 2U);
  EXPECT_EQ(recording->ticks[0].marg_end, 2U);
}

TEST(CsvReaderTest, UnknownSegmentIsNamed) {
  EXPECT_THAT(
      Read("time_s,sensor,segment,accel_x_m_s2,accel_y_m_s2,accel_z_m_s2\n0,a,tail,0,0,9.81\n")
          .error()
          .message,
      HasSubstr("f.csv:2: column 'segment': unknown segment 'tail'"));
}

TEST(CsvReaderTest, OrientationColumnsGiveFusedOrientations) {
  const std::string header =
      "time_s,sensor,q_earth_sensor_w,q_earth_sensor_x,q_earth_sensor_y,q_earth_sensor_z,"
      "truth_q_earth_sensor_w,truth_q_earth_sensor_x,truth_q_earth_sensor_y,"
      "truth_q_earth_sensor_z,movement\n";
  const Result<Recording> recording =
      Read(header + "0,head,1,0,0,0,-1,0,0,0,1\n0.1,head,1,0,0,0,,,,,0\n");
  ASSERT_TRUE(recording.ok()) << recording.error().message;
  ASSERT_EQ(recording->orientation.size(), 2U);
  EXPECT_EQ(recording->orientation[0].flags, sensing::kGyroMissing | sensing::kAccelMissing);
  ASSERT_EQ(recording->truth.size(), 1U);
  EXPECT_EQ(recording->truth[0].q_earth_sensor.w(), 1.0);
  EXPECT_EQ(recording->movement, (std::vector<std::uint8_t>{1, 0}));
  EXPECT_THAT(Read(header + "0,head,2,0,0,0,,,,,\n").error().message,
              HasSubstr("norm of the quaternion must be 1, is 2"));
}

}  // namespace
}  // namespace limbcast::gateway
