#include "common/filters/position/interval_smoother.hpp"

#include <gtest/gtest.h>

#include <Eigen/Cholesky>
#include <algorithm>

#include "common/math/rotation.hpp"
#include "tests/unit/common/filters/position/optical_scene.hpp"

namespace limbcast::filters {
namespace {

using test_support::FeedRow;
using test_support::OpticalScene;
using test_support::OpticalSceneConfig;

class IntervalSmootherTest : public ::testing::Test {
 protected:
  IntervalSmootherTest() : scene(Config()), from(scene.first_moving_row + 1400), to(from + 200) {
    scene.Hide(from, to);
    OpticalInertialFilter filter{OpticalInertialConfig{}};
    for (std::size_t row = 0; row < scene.rows(); ++row) {
      if (FeedRow(filter, scene, row).epoch_closed) {
        history.Push(filter.epoch());
      }
    }
    last = filter.state();
  }
  static OpticalSceneConfig Config() {
    OpticalSceneConfig config;
    config.motion_s = 12.0;
    config.gyro_noise_rad_s = 0.002;
    config.accel_noise_m_s2 = 0.03;
    config.marker_noise_m = 1.5e-4;
    config.errors.gyro_bias_rad_s = {0.005, -0.004, 0.003};
    return config;
  }
  OpticalScene scene;
  std::size_t from, to;
  OpticalHistory history;
  OpticalInertialState last;
};

TEST_F(IntervalSmootherTest, FillsAGapFromBothSidesAndKnowsHowWell) {
  const auto smoothed = history.Smooth();
  ASSERT_EQ(smoothed.size(), history.forward().size());
  double worst_forward_m = 0.0;
  double worst_m = 0.0;
  double nees = 0.0;
  int n = 0;
  for (std::size_t i = 0; i < smoothed.size(); ++i) {
    const std::size_t row = scene.RowOf(smoothed[i].at);
    if (row < from || row >= to) {
      continue;
    }
    const Eigen::Vector3d e = smoothed[i].p_earth_marker_m - scene.p_earth_marker_m[row];
    worst_m = std::max(worst_m, e.norm());
    worst_forward_m =
        std::max(worst_forward_m,
                 (history.forward()[i].p_earth_marker_m - scene.p_earth_marker_m[row]).norm());
    nees += e.dot(smoothed[i].cov_position_m2.ldlt().solve(e));
    ++n;
    EXPECT_EQ(smoothed[i].fill, FillKind::kInertialSmoothed);
  }
  EXPECT_LT(worst_m, 0.2 * worst_forward_m);
  EXPECT_LT(worst_m, 2e-3);  // 1 s
  EXPECT_LT(nees / n, 9.0);
  EXPECT_EQ(smoothed.back().fill, FillKind::kMeasured);
}

TEST_F(IntervalSmootherTest, VelocityAccelerationAndAttitudeAreThoseOfTheMotion) {
  const auto smoothed = history.Smooth();
  for (std::size_t i = smoothed.size() / 3; i < smoothed.size(); i += 50) {
    const std::size_t row = scene.RowOf(smoothed[i].at);
    if (row + 1 >= scene.rows()) {
      break;
    }
    EXPECT_LT((smoothed[i].v_earth_sensor_m_s - scene.truth[row].v_earth_sensor_m_s).norm(), 0.02);
    const Eigen::Vector3d accel_m_s2 =
        (scene.truth[row + 1].v_earth_sensor_m_s - scene.truth[row - 1].v_earth_sensor_m_s) * 100.0;
    EXPECT_LT((smoothed[i].accel_in_earth_m_s2 - accel_m_s2).norm(), 0.3);
    EXPECT_LT(math::AngleBetween_rad(smoothed[i].q_earth_sensor, scene.truth[row].q_earth_sensor),
              0.02);
  }
}

TEST_F(IntervalSmootherTest, TheSmoothedStartKnowsTheSensorErrors) {
  const OpticalInertialState start = history.SmoothedStart();
  EXPECT_LT((start.errors.gyro_bias_rad_s - last.errors.gyro_bias_rad_s).norm(), 2e-3);
  const std::size_t row = scene.RowOf(history.forward().front().at);
  EXPECT_LT(
      math::AngleBetween_rad(start.navigation.q_earth_sensor, scene.truth[row].q_earth_sensor),
      0.01);
}

}  // namespace
}  // namespace limbcast::filters
