#include "tools/limbcast/evaluate/coil_recording.hpp"

#include <gtest/gtest.h>

#include <algorithm>

#include "tests/unit/common/filters/position/optical_scene.hpp"

namespace limbcast::tool {
namespace {

// A synthetic hand in the place of a recording.
GapTrial Hand(double motion_s) {
  test_support::OpticalSceneConfig config;
  config.motion_s = motion_s;
  config.gyro_noise_rad_s = 0.002;
  config.accel_noise_m_s2 = 0.03;
  config.marker_noise_m = 1e-4;
  const test_support::OpticalScene scene(config);
  GapTrial trial;
  trial.name = "hand";
  trial.rate_hz = config.rate_hz;
  trial.samples = scene.samples;
  trial.markers = scene.markers;
  trial.movement.assign(scene.rows(), 1);
  std::fill_n(trial.movement.begin(), scene.first_moving_row, std::uint8_t{0});
  return trial;
}

TEST(CoilRecordingTest, ARealUnitUnderSimulatedPulsesIsFollowed) {
  const auto trial = MakeCoilTrial(Hand(20.0), CoilNoise::kThesis, 1);
  ASSERT_TRUE(trial);
  const CoilResult result = EvaluateTrial(*trial);
  EXPECT_EQ(result.forward.losses, 0);
  EXPECT_GT(result.forward.tracked, 0.99);
  const double forward_m =
      result.figures[static_cast<std::size_t>(CoilMethod::kForward)].position_m;
  EXPECT_LT(forward_m, 0.02);
  EXPECT_LT(result.figures[static_cast<std::size_t>(CoilMethod::kSmoothed)].position_m, forward_m);
}

TEST(CoilRecordingTest, TheMagnetometerReadsAtMost120TimesASecond) {
  const auto trial = MakeCoilTrial(Hand(10.0), CoilNoise::kModern, 1);
  ASSERT_TRUE(trial);
  const auto read = std::count_if(trial->ticks.begin(), trial->ticks.end(),
                                  [](const simulation::CoilTick& t) { return t.frame.mag_valid; });
  const double seconds = static_cast<double>(trial->ticks.size()) / trial->rate_hz;
  EXPECT_NEAR(static_cast<double>(read), 120.0 * seconds, 2.0);
  for (const simulation::CoilTick& tick : trial->ticks) {
    EXPECT_GT(tick.p_emitter_sensor_m.norm(), 0.14);
  }
}

TEST(CoilRecordingTest, WithoutMotionThereIsNoTrial) {
  GapTrial still = Hand(2.0);
  still.samples.resize(500);
  still.markers.resize(500);
  still.movement.assign(500, 0);
  EXPECT_FALSE(MakeCoilTrial(still, CoilNoise::kThesis, 1));
}

}  // namespace
}  // namespace limbcast::tool
