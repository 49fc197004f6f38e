#include "tools/limbcast/json/topic_json.hpp"

#include <gtest/gtest.h>

#include <limits>

namespace limbcast::tool {
namespace {

TEST(TopicJsonTest, SampleHasFieldsWithUnitsAndFlagsByName) {
  sensing::MargSample sample;
  sample.sensor_uid = SensorUid{18'000'000'000'000'000'001ULL};
  sample.sequence = 7;
  sample.flags = sensing::kMagMissing | sensing::kGyroSaturated;
  sample.measured_at = TimeFromNanoseconds(1'700'000'000'000'000'123);
  sample.gyro_rad_s = {0.5F, -1.0F, 2.0F};

  const nlohmann::json value = ToJson(sample);

  EXPECT_EQ(value["sensor_uid"], 18'000'000'000'000'000'001ULL);
  EXPECT_EQ(value["flags"], nlohmann::json({"mag_missing", "gyro_saturated"}));
  EXPECT_EQ(value["measured_at"], 1'700'000'000'000'000'123);
  EXPECT_EQ(value["gyro_rad_s"], nlohmann::json({0.5, -1.0, 2.0}));
}

TEST(TopicJsonTest, NumbersThatJsonCannotSayAreNull) {
  sensing::MargSample sample;
  sample.accel_m_s2 = {std::numeric_limits<float>::quiet_NaN(), 1.0F,
                       std::numeric_limits<float>::infinity()};
  EXPECT_EQ(ToJson(sample)["accel_m_s2"].dump(), "[null,1.0,null]");
}

TEST(TopicJsonTest, QuaternionIsWrittenWFirst) {
  body::Skeleton skeleton;
  skeleton.segments.push_back({.segment = body::Segment::kHead,
                               .status = body::SegmentStatus::kStale,
                               .confidence = 0.5F,
                               .q_earth_segment = {0.5F, -0.5F, 0.5F, 0.5F}});
  const nlohmann::json pose = ToJson(skeleton)["segments"][0];
  EXPECT_EQ(pose["segment"], "head");
  EXPECT_EQ(pose["status"], "stale");
  EXPECT_EQ(pose["q_earth_segment"], nlohmann::json({0.5, -0.5, 0.5, 0.5}));
}

TEST(TopicJsonTest, JointAnglesHaveTheirNames) {
  body::JointAngleFrame frame;
  frame.joints.push_back({.joint = body::Joint::kLeftShoulder,
                          .near_singular = true,
                          .confidence = 0.5F,
                          .angle_rad = {0.25F, 1.5F, -0.5F}});
  EXPECT_EQ(ToJson(frame)["joints"], nlohmann::json({{"left_shoulder",
                                                      {{"elevation_plane_rad", 0.25},
                                                       {"elevation_rad", 1.5},
                                                       {"internal_rotation_rad", -0.5},
                                                       {"confidence", 0.5},
                                                       {"near_singular", true}}}}));
}

TEST(TopicJsonTest, PositionOfASegmentStateIsThereOnlyWhenItMeansSomething) {
  body::SegmentState state;
  EXPECT_FALSE(ToJson(state).contains("p_earth_sensor_m"));
  state.has_position = true;
  EXPECT_TRUE(ToJson(state).contains("p_earth_sensor_m"));
  EXPECT_EQ(ToJson(state)["position_from"], "earth");
  state.position_reference = PositionReference::kSensor;
  state.position_from = body::Segment::kT8;
  EXPECT_EQ(ToJson(state)["position_from"], "t8");
}

TEST(TopicJsonTest, VerdictsThatNeverHappenedAreLeftOut) {
  body::SegmentState state;
  state.verdicts.Add(SampleVerdict::kFused);
  state.verdicts.Add(SampleVerdict::kRejectedDuplicate);
  EXPECT_EQ(ToJson(state)["verdicts"], nlohmann::json({{"fused", 1}, {"duplicate", 1}}));
}

TEST(TopicJsonTest, HealthIsAnObjectOfNamedValues) {
  ServiceHealth health;
  health.values = {{"samples.lost", 3.0}};
  health.latencies = {{.stage = "fusion", .count = 5, .p50_us = 1.5F}};
  const nlohmann::json value = ToJson(health);
  EXPECT_EQ(value["values"]["samples.lost"], 3.0);
  EXPECT_EQ(value["latencies"]["fusion"]["p50_us"], 1.5);
}

TEST(TopicJsonTest, KeysAreThoseOfTheWireContract) {
  EXPECT_EQ(KeyToJson(sensing::MargSample{}), nlohmann::json({{"sensor_uid", 0}}));
  EXPECT_EQ(KeyToJson(body::SegmentState{}),
            nlohmann::json({{"body_id", 0}, {"segment", "pelvis"}}));
  EXPECT_EQ(KeyToJson(roster::Command{}), nlohmann::json({{"client_uid", 0}}));
  EXPECT_EQ(KeyToJson(ServiceHealth{}), nlohmann::json({{"process_uid", 0}}));
}

}  // namespace
}  // namespace limbcast::tool
