#include "services/gateway/drivers/replay/xsens_reader.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "services/gateway/drivers/replay/recording_reader.hpp"
#include "tests/support/shared_data.hpp"
#include "tests/unit/services/gateway/drivers/replay/recording_fixtures.hpp"

namespace limbcast::gateway {
namespace {

using ::testing::HasSubstr;

constexpr std::string_view kHeader =
    "// Start Time: Unknown\n// Update Rate: 50.0Hz\n"
    "PacketCounter\tYear\tAcc_X\tAcc_Y\tAcc_Z\tMat[1][1]\tMat[2][1]\tMat[3][1]\tMat[1][2]\t"
    "Mat[2][2]\tMat[3][2]\tMat[1][3]\tMat[2][3]\tMat[3][3]\n";

// A quarter turn about z: x of the sensor points to y of the earth.
std::string Row(int counter) {
  return std::to_string(counter) + "\t\t0.0\t0.0\t9.81\t0\t1\t0\t-1\t0\t0\t0\t0\t1\n";
}

Result<Recording> Read(const std::string& rows) {
  return ReadXsensText({{.name = "f.txt", .serial = "00A", .text = std::string(kHeader) + rows}},
                       {});
}

TEST(XsensReaderTest, ReadsMatrixColumnByColumn) {
  const Result<Recording> recording = Read(Row(472) + Row(473));
  ASSERT_TRUE(recording.ok()) << recording.error().message;
  ASSERT_EQ(recording->orientation.size(), 2U);
  const sensing::FusedOrientation& sample = recording->orientation[1];
  EXPECT_TRUE(
      (sample.q_earth_sensor * Eigen::Vector3d::UnitX()).isApprox(Eigen::Vector3d::UnitY()));
  EXPECT_EQ(sample.accel_m_s2.z(), 9.81F);
  EXPECT_EQ(sample.flags, sensing::kGyroMissing);
  EXPECT_EQ(ToNanoseconds(sample.measured_at), 20'000'000);
}

TEST(XsensReaderTest, CounterGapsBecomeTimeAndAreCounted) {
  const Result<Recording> recording = Read(Row(10) + Row(14) + Row(15));
  ASSERT_TRUE(recording.ok());
  ASSERT_EQ(recording->ticks.size(), 3U);
  EXPECT_EQ(recording->ticks[1].device_lost, 3U);
  EXPECT_EQ(ToNanoseconds(recording->ticks[1].at), 80'000'000);
  EXPECT_EQ(recording->ticks[2].device_lost, 0U);
}

TEST(XsensReaderTest, CounterWrapsAtSixteenBits) {
  const Result<Recording> recording = Read(Row(65535) + Row(0) + Row(1));
  ASSERT_TRUE(recording.ok());
  EXPECT_EQ(ToNanoseconds(recording->ticks[2].at), 40'000'000);
  EXPECT_EQ(recording->ticks[1].device_lost, 0U);
}

TEST(XsensReaderTest, PacketsOutOfOrderAreKeptWithTheirTime) {
  const Result<Recording> recording = Read(Row(10) + Row(12) + Row(11) + Row(13));
  ASSERT_TRUE(recording.ok());
  ASSERT_EQ(recording->orientation.size(), 4U);
  EXPECT_EQ(recording->out_of_order, 1U);
  EXPECT_EQ(ToNanoseconds(recording->orientation[2].measured_at), 20'000'000);
  EXPECT_EQ(recording->ticks.size(), 3U);  // the late packet arrives with the one of 12
}

TEST(XsensReaderTest, FilesShareOneTimeAndGiveOneTick) {
  const std::string text(kHeader);
  const Result<Recording> recording =
      ReadXsensText({{.name = "a", .serial = "00A", .text = text + Row(5) + Row(6)},
                     {.name = "b", .serial = "00B", .text = text + Row(6) + Row(7)}},
                    {});
  ASSERT_TRUE(recording.ok());
  ASSERT_EQ(recording->ticks.size(), 3U);
  EXPECT_EQ(recording->ticks[0].orientation_end, 1U);
  EXPECT_EQ(recording->ticks[1].orientation_end, 3U);
  EXPECT_EQ(recording->ticks[2].orientation_end, 4U);
}

TEST(XsensReaderTest, RefusalsNameFileLineAndReason) {
  EXPECT_THAT(Read("7\t\tx\t0\t9.81\t0\t1\t0\t-1\t0\t0\t0\t0\t1\n").error().message,
              HasSubstr("f.txt:4: column 3: 'x' is no number"));
  EXPECT_THAT(Read("7\t\t1\n").error().message, HasSubstr("f.txt:4: has 3 columns, expected 14"));
  EXPECT_THAT(Read("7\t\t0\t0\t9.81\t2\t0\t0\t0\t1\t0\t0\t0\t1\n").error().message,
              HasSubstr("f.txt:4: Mat is no rotation matrix"));
  EXPECT_THAT(ReadXsensText({{"g", "s", "// Update Rate: 100.0Hz\nPacketCounter\tAcc_X\n"}}, {})
                  .error()
                  .message,
              HasSubstr("g:2: column 'Mat[1][1]' is missing"));
  EXPECT_THAT(
      ReadXsensText({{"g", "s", "// Update Rate: 0Hz\nPacketCounter\n"}}, {}).error().message,
      HasSubstr("g:1: Update Rate must be in (0, 100000] Hz"));
}

TEST(XsensReaderTest, FolderWithoutExportsIsNotFound) {
  const test::TemporaryFolder folder;
  test::WriteText(folder.path() / "notes.txt", "hello\n");
  const Result<std::vector<XsensFile>> files = LoadXsensFolder(folder.path());
  ASSERT_FALSE(files.ok());
  EXPECT_EQ(files.error().code, ErrorCode::kNotFound);
}

TEST(XsensReaderTest, SerialIsTheLastPartOfTheFileName) {
  const test::TemporaryFolder folder;
  test::WriteText(folder.path() / "MT_1_009-001_00B4.txt", std::string(kHeader) + Row(1));
  const Result<std::vector<XsensFile>> files = LoadXsensFolder(folder.path());
  ASSERT_TRUE(files.ok());
  EXPECT_EQ(files->front().serial, "00B4");
}

// The files hold 2432 to 2505 rows (their lines less the header); counters start at 472 in all.
TEST(XsensReaderTest, ReadsTheRealFolder) {
  LIMBCAST_SKIP_WITHOUT_SHARED("data/xsens_lowerbody");
  const Result<Recording> recording =
      ReadRecording(*test_support::SharedPath("data/xsens_lowerbody"),
                    {.assignments = {{"00B42279", "pelvis"}, {"00B42268", "t8"}}});
  ASSERT_TRUE(recording.ok()) << recording.error().message;
  EXPECT_EQ(recording->sensors.size(), 8U);
  EXPECT_EQ(recording->ticks.size(), 2505U);
  EXPECT_EQ(recording->orientation.size(),
            2432U + 2481U + 2452U + 2469U + 2496U + 2493U + 2474U + 2505U);
  EXPECT_EQ(recording->out_of_order, 0U);
  // Standing at the start: up in earth coordinates is what the accelerometers feel.
  for (std::size_t i = 0; i < 8; ++i) {
    const sensing::FusedOrientation& sample = recording->orientation[i];
    const Eigen::Vector3d up = sample.q_earth_sensor * sample.accel_m_s2.cast<double>();
    EXPECT_GT(up.normalized().z(), 0.99);
  }
}

}  // namespace
}  // namespace limbcast::gateway
