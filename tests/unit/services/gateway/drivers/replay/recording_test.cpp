#include "services/gateway/drivers/replay/recording.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

namespace limbcast::gateway {
namespace {

using ::testing::HasSubstr;

Recording TwoSensors() {
  Recording recording;
  recording.source = "r";
  for (const char* label : {"a", "b"}) {
    recording.sensors.push_back(
        {.info = MakeReplayInfo(std::string("r/") + label, label, 100.0, {}),
         .segment = std::nullopt});
  }
  return recording;
}

TEST(RecordingTest, RowTimesAreToTheNanosecondAndDoNotDrift) {
  EXPECT_EQ(ToNanoseconds(RowTime(1, 2000.0 / 7.0)), 3'500'000);
  EXPECT_EQ(ToNanoseconds(RowTime(1'000'000, 2000.0 / 7.0)), 3'500'000'000'000);
}

TEST(RecordingTest, SensorUidDependsOnSerialAndSuffixOnly) {
  const RecordingOptions second{.serial_suffix = "#2"};
  EXPECT_EQ(MakeReplayInfo("s", "x", 1.0, {}).sensor_uid,
            MakeReplayInfo("s", "y", 2.0, {}).sensor_uid);
  EXPECT_NE(MakeReplayInfo("s", "x", 1.0, {}).sensor_uid,
            MakeReplayInfo("s", "x", 1.0, second).sensor_uid);
  EXPECT_LE(MakeReplayInfo(std::string(99, 's'), std::string(99, 'l'), 1.0, {}).serial.size(), 64U);
}

TEST(RecordingTest, AssignmentFindsSensorsByLabelOrSerial) {
  Recording recording = TwoSensors();
  ASSERT_TRUE(Assign(recording, {.assignments = {{"a", "head"}, {"r/b", "pelvis"}}}).ok());
  EXPECT_EQ(recording.sensors[0].segment, body::Segment::kHead);
  EXPECT_EQ(recording.sensors[1].segment, body::Segment::kPelvis);
}

TEST(RecordingTest, WrongAssignmentsAreNamed) {
  Recording recording = TwoSensors();
  EXPECT_THAT(Assign(recording, {.assignments = {{"a", "tail"}}}).error().message,
              HasSubstr("sensor 'a': unknown segment 'tail'"));
  EXPECT_EQ(Assign(recording, {.assignments = {{"c", "head"}}}).error().message,
            "unknown sensor 'c' in r, which has a, b");
  EXPECT_EQ(Assign(recording, {.assignments = {{"a", "head"}, {"b", "head"}}}).error().message,
            "two sensors on segment 'head', the second is 'b'");
}

TEST(RecordingTest, OnlyExactRepeatsOfTheSameSensorCountAsHeld) {
  Recording recording = TwoSensors();
  const auto add = [&](std::size_t sensor, float mag, std::uint32_t flags) {
    sensing::MargSample sample;
    sample.sensor_uid = recording.sensors[sensor].info.sensor_uid;
    sample.flags = flags;
    sample.mag_tesla.setConstant(mag);
    recording.marg.push_back(sample);
  };
  add(0, 1.0F, 0);
  add(1, 1.0F, 0);                     // the other sensor's first
  add(0, 1.0F, 0);                     // held
  add(0, 1.0F, sensing::kMagMissing);  // nothing to hold
  add(0, std::nanf(""), 0);
  add(0, std::nanf(""), 0);  // NaN repeats nothing
  add(0, 1.0F, 0);
  MarkHeldMagnetometer(recording);
  std::vector<bool> held;
  for (const sensing::MargSample& sample : recording.marg) {
    held.push_back(sample.Has(sensing::kMagHeld));
  }
  EXPECT_EQ(held, (std::vector<bool>{false, false, true, false, false, false, false}));
}

}  // namespace
}  // namespace limbcast::gateway
