#include "common/filters/position/optical_start.hpp"

#include <gtest/gtest.h>

#include "common/math/rotation.hpp"
#include "tests/unit/common/filters/position/optical_scene.hpp"

namespace limbcast::filters {
namespace {

using test_support::OpticalScene;
using test_support::OpticalSceneConfig;

struct Found {
  std::optional<OpticalStartResult> result;
  std::size_t row = 0;
  double searched_s = 0.0;
};

Found Search(const OpticalScene& scene) {
  OpticalStart start(9.81);
  InertialGate gate(0.0, 0.0);
  Found found;
  for (; found.row < scene.rows() && !found.result; ++found.row) {
    std::optional<TimedMarker> marker;
    if (scene.markers[found.row].visible) {
      marker = TimedMarker{scene.markers[found.row].measured_at,
                           scene.markers[found.row].p_earth_marker_m, 0.0};
    }
    found.result = start.Add(scene.samples[found.row].measured_at,
                             gate.Pass(scene.samples[found.row]), marker);
    found.searched_s = start.searched_s();
  }
  --found.row;
  return found;
}

TEST(OpticalStartTest, FindsAttitudeInTheFirstMovingWindow) {
  OpticalSceneConfig config;
  config.heading_rad = 2.2;
  config.errors.gyro_bias_rad_s = {0.01, -0.005, 0.008};
  config.gyro_noise_rad_s = 0.002;
  config.accel_noise_m_s2 = 0.05;
  config.marker_noise_m = 2e-4;
  const OpticalScene scene(config);
  const Found found = Search(scene);
  ASSERT_TRUE(found.result.has_value());
  const NavigationState& truth = scene.truth[found.row];
  EXPECT_LT(math::AngleBetween_rad(found.result->navigation.q_earth_sensor, truth.q_earth_sensor),
            0.03);
  EXPECT_LT((found.result->navigation.p_earth_sensor_m - truth.p_earth_sensor_m).norm(), 0.01);
  EXPECT_LT((found.result->navigation.v_earth_sensor_m_s - truth.v_earth_sensor_m_s).norm(), 0.05);
  EXPECT_LT((found.result->gyro_bias_rad_s - config.errors.gyro_bias_rad_s).norm(), 1e-3);
  EXPECT_TRUE(found.result->had_rest);
  // The rest before the motion, for those who can go back to it.
  EXPECT_LT(ToSeconds(found.result->rest_begun_at - Time{}), 0.1);
  EXPECT_LT(
      math::AngleBetween_rad(found.result->q_earth_sensor_at_rest, scene.truth[0].q_earth_sensor),
      0.03);
  EXPECT_LT(found.row, scene.first_moving_row + 4 * 200);
}

TEST(OpticalStartTest, WithoutMotionOrMarkersThereIsNoStart) {
  OpticalSceneConfig config;
  config.amplitude_m = 0.0;
  config.rate_rad_s = 0.0;
  EXPECT_FALSE(Search(OpticalScene(config)).result.has_value());
  config = {};
  OpticalScene blind(config);
  blind.Hide(0, blind.rows());
  const Found found = Search(blind);
  EXPECT_FALSE(found.result.has_value());
  EXPECT_GT(found.searched_s, 10.0);
}

TEST(OpticalStartTest, WithoutRestTheMeanForceLevels) {
  OpticalSceneConfig config;
  config.rest_s = 0.0;
  config.motion_s = 20.0;
  config.rate_rad_s = 0.8;
  const OpticalScene scene(config);
  const Found found = Search(scene);
  ASSERT_TRUE(found.result.has_value());
  EXPECT_FALSE(found.result->had_rest);
  EXPECT_LT(math::AngleBetween_rad(found.result->navigation.q_earth_sensor,
                                   scene.truth[found.row].q_earth_sensor),
            0.2);
}

TEST(OpticalStartTest, AGuessHasTheHeadingAskedFor) {
  OpticalStart start(9.81);
  EXPECT_FALSE(start.Guess(0.0).has_value());
  InertialGate gate(0.0, 0.0);
  OpticalSceneConfig config;
  config.motion_s = 0.0;
  const OpticalScene scene(config);
  for (std::size_t row = 0; row < scene.rows(); ++row) {
    (void)start.Add(scene.samples[row].measured_at, gate.Pass(scene.samples[row]),
                    TimedMarker{scene.samples[row].measured_at, {1.0, 2.0, 3.0}, 0.0});
  }
  const auto guess = start.Guess(1.0);
  ASSERT_TRUE(guess.has_value());
  const auto other = start.Guess(1.5);
  EXPECT_NEAR(math::Heading_rad(other->navigation.q_earth_sensor *
                                guess->navigation.q_earth_sensor.conjugate()),
              0.5, 1e-9);
  EXPECT_EQ(guess->navigation.p_earth_sensor_m, Eigen::Vector3d(1.0, 2.0, 3.0));
}

}  // namespace
}  // namespace limbcast::filters
