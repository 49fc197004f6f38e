#include "services/gateway/drivers/replay/recording_reader.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/unit/services/gateway/drivers/replay/recording_fixtures.hpp"

namespace limbcast::gateway {
namespace {

using ::testing::HasSubstr;

constexpr std::string_view kCsv =
    "time_s,sensor,accel_x_m_s2,accel_y_m_s2,accel_z_m_s2\n0,head,0,0,9.81\n";

class RecordingReaderTest : public ::testing::Test {
 protected:
  std::filesystem::path File(const std::string& name) { return folder_.path() / name; }
  test::TemporaryFolder folder_;
};

TEST_F(RecordingReaderTest, FormatIsToldByContentNotByName) {
  test::WriteHdf5(File("a.csv"), test::BroadDatasets(3), 100.0);
  test::WriteText(File("b.hdf5"), kCsv);
  EXPECT_EQ(ReadRecording(File("a.csv"))->format, "broad");
  EXPECT_EQ(ReadRecording(File("b.hdf5"))->format, "csv");
}

TEST_F(RecordingReaderTest, MissingFileIsNotFound) {
  const Result<Recording> recording = ReadRecording(File("none.hdf5"));
  ASSERT_FALSE(recording.ok());
  EXPECT_EQ(recording.error().code, ErrorCode::kNotFound);
  EXPECT_THAT(recording.error().message, HasSubstr("no such recording"));
}

TEST_F(RecordingReaderTest, TruncatedHdf5IsCorrupt) {
  test::WriteHdf5(File("a.hdf5"), test::BroadDatasets(50), 100.0);
  std::filesystem::resize_file(File("a.hdf5"), 1000);
  const Result<Recording> recording = ReadRecording(File("a.hdf5"));
  ASSERT_FALSE(recording.ok());
  EXPECT_EQ(recording.error().code, ErrorCode::kCorruptData);
  EXPECT_THAT(recording.error().message, HasSubstr("truncated"));
}

TEST_F(RecordingReaderTest, UnknownBytesAndEmptyFilesAreRefused) {
  test::WriteText(File("noise"), std::string_view("\x01\x02\x00\x03,", 5));
  test::WriteText(File("empty"), "");
  EXPECT_EQ(ReadRecording(File("noise")).error().code, ErrorCode::kUnsupported);
  EXPECT_EQ(ReadRecording(File("empty")).error().code, ErrorCode::kUnsupported);
}

TEST_F(RecordingReaderTest, RecordingWithoutSamplesIsRefused) {
  test::WriteText(File("a.csv"), kCsv.substr(0, kCsv.find('\n') + 1));
  EXPECT_THAT(ReadRecording(File("a.csv")).error().message, HasSubstr("holds no samples"));
}

TEST_F(RecordingReaderTest, AssignmentsGoOverTheRecording) {
  test::WriteText(File("a.csv"), kCsv);
  EXPECT_EQ(ReadRecording(File("a.csv"))->sensors[0].segment, body::Segment::kHead);
  EXPECT_EQ(ReadRecording(File("a.csv"), {.assignments = {{"head", "neck"}}})->sensors[0].segment,
            body::Segment::kNeck);
  EXPECT_EQ(ReadRecording(File("a.csv"), {.assignments = {{"head", "tail"}}}).error().code,
            ErrorCode::kInvalidArgument);
}

}  // namespace
}  // namespace limbcast::gateway
