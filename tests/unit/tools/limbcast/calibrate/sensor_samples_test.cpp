#include "tools/limbcast/calibrate/sensor_samples.hpp"

#include <gtest/gtest.h>

namespace limbcast::tool {
namespace {

const std::vector<sensing::SensorInfo> kSensors = {
    {.sensor_uid = SensorUid{1},
     .driver = {},
     .serial = "00A",
     .label = "pelvis",
     .calibration = {}},
    {.sensor_uid = SensorUid{2}, .driver = {}, .serial = "00B", .label = "00B", .calibration = {}}};

sensing::MargSample At(std::uint64_t uid, std::int64_t ns, std::uint32_t flags = 0) {
  sensing::MargSample sample;
  sample.sensor_uid = SensorUid{uid};
  sample.measured_at = TimeFromNanoseconds(ns);
  sample.flags = flags;
  return sample;
}

TEST(SensorSamplesTest, SortsBySensorAndTimeWithoutProbesAndDoubles) {
  const std::vector<sensing::MargSample> samples = {At(2, 10), At(1, 20), At(1, 10), At(1, 20),
                                                    At(1, 5, sensing::kProbe)};
  const auto sorted = SamplesBySensor(kSensors, samples, "");
  ASSERT_TRUE(sorted.ok());
  ASSERT_EQ(sorted->size(), 2U);
  ASSERT_EQ((*sorted)[0].samples.size(), 2U);
  EXPECT_EQ((*sorted)[0].samples[0].measured_at, TimeFromNanoseconds(10));
  EXPECT_EQ((*sorted)[0].Name(), "pelvis (00A)");
  EXPECT_EQ((*sorted)[1].Name(), "00B");
}

TEST(SensorSamplesTest, TheLimbIsNamedWhereItIsKnown) {
  SensorSamples sensor{.info = kSensors[1], .samples = {}, .limb = "head"};
  EXPECT_EQ(sensor.Name(), "00B on head");
  sensor = {.info = kSensors[0], .samples = {}, .limb = "pelvis"};
  EXPECT_EQ(sensor.Name(), "pelvis (00A)") << "the label says it";
}

TEST(SensorSamplesTest, ASensorIsChosenByLabelOrSerial) {
  const std::vector<sensing::MargSample> samples = {At(1, 1), At(2, 1)};
  EXPECT_EQ(SamplesBySensor(kSensors, samples, "pelvis")->front().info.serial, "00A");
  EXPECT_EQ(SamplesBySensor(kSensors, samples, "00A")->size(), 1U);
  EXPECT_EQ(SamplesBySensor(kSensors, samples, "head").error().message,
            "no sensor 'head', there are: pelvis, 00B");
  EXPECT_EQ(SamplesBySensor(kSensors, {}, "").error().code, ErrorCode::kNotFound);
}

}  // namespace
}  // namespace limbcast::tool
