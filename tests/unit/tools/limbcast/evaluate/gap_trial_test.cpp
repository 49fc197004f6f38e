#include "tools/limbcast/evaluate/gap_trial.hpp"

#include <gtest/gtest.h>

#include <filesystem>

#include "services/gateway/drivers/replay/recording_reader.hpp"
#include "tests/support/shared_data.hpp"
#include "tests/unit/common/filters/position/optical_scene.hpp"

namespace limbcast::tool {
namespace {

using test_support::OpticalScene;
using test_support::OpticalSceneConfig;

GapTrial TrialOf(const OpticalScene& scene, double rate_hz) {
  GapTrial trial;
  trial.name = "hand";
  trial.rate_hz = rate_hz;
  trial.samples = scene.samples;
  trial.markers = scene.markers;
  trial.movement.assign(scene.rows(), 1);
  std::fill_n(trial.movement.begin(), scene.first_moving_row, std::uint8_t{0});
  return trial;
}

OpticalScene Hand() {
  OpticalSceneConfig config;
  config.motion_s = 20.0;
  config.gyro_noise_rad_s = 0.002;
  config.accel_noise_m_s2 = 0.03;
  config.marker_noise_m = 1e-4;
  return OpticalScene(config);
}

TEST(GapTrialTest, GapsLieWhereTheRuleSays) {
  GapTrial trial = TrialOf(Hand(), 200.0);
  const std::size_t first = 600 + 1000;  // 3 s of rest, 5 s after
  std::vector<Gap> gaps = PlaceGaps(trial, 0.5);
  ASSERT_EQ(gaps.size(), 5U);
  for (std::size_t k = 0; k < gaps.size(); ++k) {
    EXPECT_EQ(gaps[k].begin, first + k * 700);
    EXPECT_EQ(gaps[k].end, gaps[k].begin + 100);
  }
  trial.movement[first + 720] = 0;                     // the second is not all in motion
  trial.markers[first + 2 * 700 - 1].visible = false;  // the third has no end to begin from
  for (std::size_t i = 0; i < 11; ++i) {               // the fourth has too little truth
    trial.markers[first + 3 * 700 + i].visible = false;
  }
  gaps = PlaceGaps(trial, 0.5);
  ASSERT_EQ(gaps.size(), 2U);
  EXPECT_EQ(gaps[1].begin, first + 4 * 700);
}

TEST(GapTrialTest, InertiaBeatsTheSplineAndSmoothingBeatsForward) {
  const GapTrial trial = TrialOf(Hand(), 200.0);
  const GapResult result = EvaluateGaps({}, trial, 0.5);
  EXPECT_EQ(result.gaps, 5U);
  const auto& f = result.fills;
  EXPECT_GT(f[3].mean_max_m, 0.03);
  EXPECT_LT(f[0].mean_max_m, 0.2 * f[3].mean_max_m);
  EXPECT_LT(f[2].mean_max_m, 0.5 * f[0].mean_max_m);
  EXPECT_LE(f[2].mean_max_m, 1.1 * f[1].mean_max_m);
  EXPECT_GE(f[2].worst_max_m, f[2].mean_max_m);
  EXPECT_LE(f[2].mean_max_z_m, f[2].mean_max_m);
}

TEST(GapTrialTest, AMarkerWithEverySampleIsFollowedClosely) {
  const GapTrial trial = TrialOf(Hand(), 200.0);
  const GapResult every = EvaluateRatio({}, trial, 1);
  EXPECT_LT(every.fills[2].rms_m, 2e-4);
  const GapResult few = EvaluateRatio({}, trial, 100);
  EXPECT_GT(few.fills[0].rms_m, few.fills[2].rms_m);
  EXPECT_LT(few.fills[2].max_m, 5e-3);
}

TEST(GapTrialTest, TakesTheFirstSensorWithPositions) {
  gateway::Recording recording;
  recording.rate_hz = 100.0;
  recording.sensors.resize(2);
  recording.sensors[1].info.sensor_uid = MakeSensorUid("test", "second");
  for (int row = 0; row < 4; ++row) {
    for (const auto& sensor : recording.sensors) {
      sensing::MargSample sample;
      sample.sensor_uid = sensor.info.sensor_uid;
      sample.measured_at = Time{} + std::chrono::milliseconds(10 * row);
      recording.marg.push_back(sample);
      body::SegmentTruth truth;
      truth.sensor_uid = sensor.info.sensor_uid;
      truth.measured_at = sample.measured_at;
      truth.segment_valid =
          sensor.info.sensor_uid == recording.sensors[1].info.sensor_uid && row != 2;
      truth.p_earth_segment_m = {0.1 * row, 0.0, 0.0};
      recording.truth.push_back(truth);
    }
    recording.movement.push_back(row > 0 ? 1 : 0);
    gateway::CloseTick(recording, Time{} + std::chrono::milliseconds(10 * row));
  }
  const auto trial = GapTrialOf(recording, "two");
  ASSERT_TRUE(trial.has_value());
  ASSERT_EQ(trial->samples.size(), 4U);
  EXPECT_TRUE(trial->markers[3].visible);
  EXPECT_FALSE(trial->markers[2].visible);
  EXPECT_EQ(trial->markers[3].p_earth_marker_m.x(), 0.1 * 3);
  EXPECT_EQ(trial->movement, (std::vector<std::uint8_t>{0, 1, 1, 1}));
  recording.truth.clear();
  EXPECT_FALSE(GapTrialOf(recording, "two").has_value());
}

// Issue 5, figure 1, on one quiet trial and the worst one. The bounds are those of the whole set.
TEST(GapTrialTest, BroadGapsAreFilledAsPromised) {
  LIMBCAST_SKIP_WITHOUT_SHARED("data/broad");
  const std::filesystem::path folder = *test_support::SharedPath("data/broad");
  const auto recording = gateway::ReadRecording(folder / "24_disturbed_tapping_A.hdf5");
  ASSERT_TRUE(recording.ok());
  const auto trial = GapTrialOf(*recording, "24");
  ASSERT_TRUE(trial.has_value());
  const GapResult half = EvaluateGaps({}, *trial, 0.5);
  EXPECT_LT(half.fills[2].mean_max_m, 1.8e-3);
  EXPECT_LT(half.fills[1].mean_max_m, 3.2e-3);
}

}  // namespace
}  // namespace limbcast::tool
