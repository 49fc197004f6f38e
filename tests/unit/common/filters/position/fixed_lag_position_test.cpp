#include "common/filters/position/fixed_lag_position.hpp"

#include <gtest/gtest.h>

#include "common/filters/position/interval_smoother.hpp"
#include "common/math/rotation.hpp"
#include "tests/unit/common/filters/position/optical_scene.hpp"

namespace limbcast::filters {
namespace {

using test_support::FeedRow;
using test_support::OpticalScene;
using test_support::OpticalSceneConfig;

OpticalScene HandWithGap() {
  OpticalSceneConfig config;
  config.motion_s = 10.0;
  config.gyro_noise_rad_s = 0.002;
  config.accel_noise_m_s2 = 0.03;
  config.marker_noise_m = 1.5e-4;
  OpticalScene scene(config);
  scene.Hide(scene.first_moving_row + 1400, scene.first_moving_row + 1500);
  return scene;
}

TEST(FixedLagPositionTest, IsTheIntervalSmootherOfWhatWasSeenUntilNow) {
  const OpticalScene scene = HandWithGap();
  OpticalInertialConfig config;
  config.lag_s = 0.3;
  OpticalInertialFilter filter(config);
  FixedLagPosition lag(config);
  OpticalHistory history;
  int compared = 0;
  for (std::size_t row = 0; row < scene.rows(); ++row) {
    if (!FeedRow(filter, scene, row).epoch_closed) {
      continue;
    }
    history.Push(filter.epoch());
    lag.Push(filter.epoch());
    if (row % 97 != 0 || !lag.has_estimate()) {
      continue;
    }
    const auto smoothed = history.Smooth();
    const PositionEstimate& estimate = lag.estimate();
    const auto same = std::find_if(smoothed.begin(), smoothed.end(),
                                   [&](const auto& s) { return s.at == estimate.at; });
    ASSERT_NE(same, smoothed.end());
    EXPECT_NEAR(ToSeconds(filter.epoch().at - estimate.at), 0.3, 1e-9);
    EXPECT_LT((same->p_earth_marker_m - estimate.p_earth_marker_m).norm(), 1e-9);
    EXPECT_LT((same->v_earth_sensor_m_s - estimate.v_earth_sensor_m_s).norm(), 1e-9);
    EXPECT_LT((same->accel_in_earth_m_s2 - estimate.accel_in_earth_m_s2).norm(), 1e-7);
    EXPECT_LT(math::AngleBetween_rad(same->q_earth_sensor, estimate.q_earth_sensor), 1e-9);
    EXPECT_EQ(same->fill, estimate.fill);
    // Between gaps the covariance may be a few epochs old.
    EXPECT_NEAR(same->sigma_position_m() / estimate.sigma_position_m(), 1.0, 0.2);
    ++compared;
  }
  EXPECT_GT(compared, 10);
}

TEST(FixedLagPositionTest, FillsAGapFromBothSides) {
  const OpticalScene scene = HandWithGap();
  const std::size_t from = scene.first_moving_row + 1400;
  OpticalInertialFilter filter{OpticalInertialConfig{}};
  FixedLagPosition lag{OpticalInertialConfig{}};
  double worst_forward_m = 0.0;
  double worst_lag_m = 0.0;
  const auto error_m = [&](const PositionEstimate& e) {
    const std::size_t row = scene.RowOf(e.at);
    const bool inside = row >= from && row < from + 100;
    return inside ? (e.p_earth_marker_m - scene.p_earth_marker_m[row]).norm() : 0.0;
  };
  for (std::size_t row = 0; row < scene.rows(); ++row) {
    if (!FeedRow(filter, scene, row).epoch_closed) {
      continue;
    }
    lag.Push(filter.epoch());
    worst_forward_m = std::max(worst_forward_m, error_m(ForwardEstimate(filter.epoch())));
    if (lag.has_estimate() && error_m(lag.estimate()) > 0.0) {
      EXPECT_EQ(lag.estimate().fill, FillKind::kInertialSmoothed);
      EXPECT_LT(error_m(lag.estimate()), 4.0 * lag.estimate().sigma_position_m() + 1e-5);
      worst_lag_m = std::max(worst_lag_m, error_m(lag.estimate()));
    }
  }
  EXPECT_GT(worst_lag_m, 0.0);
  EXPECT_LT(worst_lag_m, 0.5 * worst_forward_m);
}

TEST(FixedLagPositionTest, ARestartBeginsANewWindow) {
  const OpticalScene scene = HandWithGap();
  OpticalInertialFilter filter{OpticalInertialConfig{}};
  FixedLagPosition lag{OpticalInertialConfig{}};
  std::size_t row = 0;
  for (; row < scene.first_moving_row + 1200; ++row) {
    if (FeedRow(filter, scene, row).epoch_closed) {
      lag.Push(filter.epoch());
    }
  }
  ASSERT_TRUE(lag.has_estimate());
  filter.Start(filter.at(), filter.state());
  while (!FeedRow(filter, scene, row++).epoch_closed) {
  }
  lag.Push(filter.epoch());
  EXPECT_FALSE(lag.has_estimate());
}

}  // namespace
}  // namespace limbcast::filters
