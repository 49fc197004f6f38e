#include "common/filters/position/offline_smoother.hpp"

#include <gtest/gtest.h>

#include <algorithm>

#include "tests/unit/common/filters/position/optical_scene.hpp"

namespace limbcast::filters {
namespace {

using test_support::OpticalScene;
using test_support::OpticalSceneConfig;

TEST(OfflineSmootherTest, GoesBackToTheRestBeforeTheMotion) {
  OpticalSceneConfig config;
  config.motion_s = 10.0;
  config.gyro_noise_rad_s = 0.002;
  config.accel_noise_m_s2 = 0.03;
  config.marker_noise_m = 1.5e-4;
  OpticalScene scene(config);
  const std::size_t from = scene.first_moving_row + 250;  // before the live filter has started
  scene.Hide(from, from + 60);
  const OfflineResult result = SmoothOffline({}, scene.samples, scene.markers);
  EXPECT_TRUE(result.began_at_rest);
  ASSERT_FALSE(result.estimates.empty());
  EXPECT_LT(ToSeconds(result.estimates.front().at - Time{}), 0.1);
  EXPECT_EQ(result.estimates.back().at, scene.samples.back().measured_at);
  double worst_m = 0.0;
  for (const PositionEstimate& e : result.estimates) {
    const std::size_t row = scene.RowOf(e.at);
    worst_m = std::max(worst_m, (e.p_earth_marker_m - scene.p_earth_marker_m[row]).norm());
  }
  EXPECT_LT(worst_m, 2e-3);
}

TEST(OfflineSmootherTest, GoesBackToWhereTheMarkerIsFirstSeenInTheRest) {
  OpticalSceneConfig config;
  config.motion_s = 10.0;
  config.gyro_noise_rad_s = 0.002;
  config.accel_noise_m_s2 = 0.03;
  config.marker_noise_m = 1.5e-4;
  OpticalScene scene(config);
  scene.Hide(0, 300);  // half of the rest
  const OfflineResult result = SmoothOffline({}, scene.samples, scene.markers);
  EXPECT_TRUE(result.began_at_rest);
  ASSERT_FALSE(result.estimates.empty());
  EXPECT_NEAR(ToSeconds(result.estimates.front().at - Time{}), 300.0 / config.rate_hz, 0.1);
}

TEST(OfflineSmootherTest, WithoutMotionThereIsNoResult) {
  OpticalSceneConfig config;
  config.motion_s = 2.0;
  config.amplitude_m = config.rate_rad_s = 0.0;
  const OpticalScene scene(config);
  EXPECT_TRUE(SmoothOffline({}, scene.samples, scene.markers).estimates.empty());
  EXPECT_TRUE(SmoothOffline({}, {}, {}).estimates.empty());
}

}  // namespace
}  // namespace limbcast::filters
