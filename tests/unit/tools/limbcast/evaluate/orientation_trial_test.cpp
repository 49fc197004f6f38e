#include "tools/limbcast/evaluate/orientation_trial.hpp"

#include <gtest/gtest.h>

#include <filesystem>

#include "common/filters/filter_factory.hpp"
#include "common/math/rotation.hpp"
#include "services/gateway/drivers/replay/recording_reader.hpp"
#include "tests/support/shared_data.hpp"

namespace limbcast::tool {
namespace {

using Eigen::Quaterniond;

// A recording of one sensor at rest for `rows` samples of 10 ms; the truth is turned by `error`
// about the vertical, and unknown in every fourth row.
gateway::Recording AtRest(int rows, double error_rad) {
  gateway::Recording recording;
  gateway::RecordedSensor sensor;
  sensor.info.label = "wrist";
  recording.sensors.push_back(sensor);
  for (int row = 0; row < rows; ++row) {
    sensing::MargSample sample;
    sample.measured_at = Time{} + std::chrono::milliseconds(10 * (row + 1));
    sample.accel_m_s2 = {0.0F, 0.0F, 9.81F};
    sample.mag_tesla = {0.0F, 20e-6F, -40e-6F};
    recording.marg.push_back(sample);
    body::SegmentTruth truth;
    truth.measured_at = sample.measured_at;
    truth.sensor_valid = row % 4 != 3;
    truth.q_earth_sensor = math::ExpSO3({0.0, 0.0, error_rad});
    recording.truth.push_back(truth);
    recording.movement.push_back(row >= rows / 2 ? 1 : 0);
    gateway::CloseTick(recording, sample.measured_at);
  }
  return recording;
}

TEST(OrientationTrialTest, ScoresMovementWithKnownTruthOnly) {
  const auto trials = TrialsOf(AtRest(200, 0.0), "still");
  ASSERT_EQ(trials.size(), 1U);
  EXPECT_EQ(trials[0].name, "still");
  EXPECT_EQ(trials[0].samples.size(), 200U);
  int scored = 0;
  for (const std::uint8_t s : trials[0].scored) {
    scored += s;
  }
  EXPECT_EQ(scored, 75);
}

TEST(OrientationTrialTest, WithoutAnyTruthThereIsNoTrial) {
  gateway::Recording recording = AtRest(20, 0.0);
  for (auto& truth : recording.truth) {
    truth.sensor_valid = false;
  }
  EXPECT_TRUE(TrialsOf(recording, "blind").empty());
}

TEST(OrientationTrialTest, EvaluatesFromTheFirstSampleWithARowForEach) {
  const auto trials = TrialsOf(AtRest(200, 0.05), "still");
  auto filter = filters::MakeFilter("tqt");
  ASSERT_TRUE(filter.ok());
  const OrientationResult result = EvaluateTrial(trials.at(0), **filter);
  EXPECT_EQ(result.q_earth_sensor.size(), 200U);
  EXPECT_EQ(result.errors.count(), 75U);
  EXPECT_NEAR(result.errors.total_rms_deg(), 0.05 * 180.0 / 3.14159265358979, 1e-4);
  EXPECT_NEAR(result.errors.inclination_rms_deg(), 0.0, 1e-4);
  EXPECT_EQ(result.verdicts.used(), 200U);
  EXPECT_FALSE(result.points.empty());
}

TEST(OrientationTrialTest, NothingIsPlottedOrJudgedWhereNothingIsKnown) {
  const auto trials = TrialsOf(AtRest(200, 0.0), "still");
  auto filter = filters::MakeFilter("bmf");
  ASSERT_TRUE(filter.ok());
  const OrientationResult result = EvaluateTrial(trials.at(0), **filter);
  ASSERT_EQ(result.points.size(), 200U);
  for (std::size_t row = 0; row < 200; ++row) {
    EXPECT_EQ(result.points[row].known, row % 4 != 3) << row;
  }
}

// Before the start there is no covariance to judge an error by.
TEST(OrientationTrialTest, NeesCountsFromTheStartOfTheFilter) {
  gateway::Recording recording = AtRest(200, 0.0);
  recording.movement.clear();  // all of it is scored
  const auto trials = TrialsOf(recording, "still");
  auto filter = filters::MakeFilter("ckf");
  ASSERT_TRUE(filter.ok());
  const OrientationResult result = EvaluateTrial(trials.at(0), **filter);
  EXPECT_EQ(result.errors.count(), 150U);
  EXPECT_LT(result.mean_nees, 1.0);
}

TEST(OrientationTrialTest, GroupsTrialsByTheirName) {
  EXPECT_EQ(GroupOf("03_undisturbed_slow_rotation_C"), TrialGroup::kUndisturbed);
  EXPECT_EQ(GroupOf("24_disturbed_tapping_A"), TrialGroup::kDisturbed);
  EXPECT_EQ(GroupOf("walk"), TrialGroup::kOther);
}

// Issue 3, figure 1, on one trial of each kind: the shipped defaults, causal, from the first
// sample. The bounds are those of the whole set and hold here with room.
TEST(OrientationTrialTest, BroadTrialsAreAsAccurateAsPromised) {
  LIMBCAST_SKIP_WITHOUT_SHARED("data/broad");
  const std::filesystem::path folder = *test_support::SharedPath("data/broad");
  for (const char* name :
       {"10_undisturbed_slow_translation_A", "35_disturbed_attached_magnet_4cm"}) {
    const auto recording = gateway::ReadRecording(folder / (std::string(name) + ".hdf5"));
    ASSERT_TRUE(recording.ok());
    const auto trials = TrialsOf(*recording, name);
    ASSERT_EQ(trials.size(), 1U);
    const auto total_deg = [&](const char* filter_name) {
      auto filter = filters::MakeFilter(filter_name);
      return EvaluateTrial(trials[0], **filter).errors.total_rms_deg();
    };
    EXPECT_LT(total_deg("bmf"), 1.80) << name;
    EXPECT_LT(total_deg("ckf"), 3.6) << name;
    EXPECT_LT(total_deg("tqt"), 4.2) << name;
  }
}

}  // namespace
}  // namespace limbcast::tool
