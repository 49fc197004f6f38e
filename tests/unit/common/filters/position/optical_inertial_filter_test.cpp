#include "common/filters/position/optical_inertial_filter.hpp"

#include <gtest/gtest.h>

#include <Eigen/Cholesky>
#include <limits>

#include "common/filters/position/optical_outputs.hpp"
#include "common/math/rotation.hpp"
#include "tests/unit/common/filters/position/optical_scene.hpp"

namespace limbcast::filters {
namespace {

using Eigen::Vector3d;
using test_support::FeedRow;
using test_support::OpticalScene;
using test_support::OpticalSceneConfig;

OpticalSceneConfig NoisyHand() {
  OpticalSceneConfig config;
  config.gyro_noise_rad_s = 0.002;
  config.accel_noise_m_s2 = 0.03;
  config.marker_noise_m = 1.5e-4;
  config.errors.gyro_bias_rad_s = {0.005, -0.004, 0.003};
  config.errors.accel_bias_m_s2 = {0.03, -0.02, 0.01};
  return config;
}

OpticalInertialFilter RunTo(const OpticalScene& scene, std::size_t row) {
  OpticalInertialFilter filter{OpticalInertialConfig{}};
  for (std::size_t i = 0; i < row; ++i) {
    (void)FeedRow(filter, scene, i);
  }
  return filter;
}

double ErrorAt_m(const OpticalInertialFilter& filter, const OpticalScene& scene) {
  const std::size_t row = scene.RowOf(filter.epoch().at);
  return (ForwardEstimate(filter.epoch()).p_earth_marker_m - scene.p_earth_marker_m[row]).norm();
}

TEST(OpticalInertialFilterTest, FindsLeverArmTimeOffsetsAndSensorErrors) {
  OpticalSceneConfig config = NoisyHand();
  config.motion_s = 40.0;
  config.p_sensor_marker_m = {0.02, -0.015, 0.03};
  config.marker_lead_s = 0.0065;
  config.errors.accel_matrix.diagonal() << 0.006, -0.004, 0.005;
  config.errors.gyro_matrix.diagonal() << -0.005, 0.004, 0.006;
  const OpticalScene scene(config);
  const OpticalInertialFilter filter = RunTo(scene, scene.rows());
  ASSERT_TRUE(filter.started());
  const OpticalInertialState& x = filter.state();
  EXPECT_LT((x.p_sensor_marker_m - config.p_sensor_marker_m).norm(), 1.5e-3);
  EXPECT_NEAR(x.marker_lead_s, config.marker_lead_s, 3e-4);
  EXPECT_NEAR(x.errors.gyro_delay_s, 0.0, 3e-4);
  EXPECT_LT((x.errors.gyro_bias_rad_s - config.errors.gyro_bias_rad_s).norm(), 2e-3);
  EXPECT_LT((x.errors.gyro_matrix.diagonal() - config.errors.gyro_matrix.diagonal()).norm(), 4e-3);
  EXPECT_LT((x.errors.accel_matrix.diagonal() - config.errors.accel_matrix.diagonal()).norm(),
            6e-3);
  // The marker's position is the one that its stamps mean: 6.5 ms later.
  const Vector3d estimated = ForwardEstimate(filter.epoch()).p_earth_marker_m;
  EXPECT_LT((estimated - scene.markers[scene.RowOf(filter.epoch().at)].p_earth_marker_m).norm(),
            1e-3);
}

TEST(OpticalInertialFilterTest, FindsAGyroThatIsLate) {
  const OpticalSceneConfig config = NoisyHand();
  OpticalScene scene(config);
  for (std::size_t row = scene.rows() - 1; row > 0; --row) {  // one sample of 5 ms
    scene.samples[row].gyro_rad_s = scene.samples[row - 1].gyro_rad_s;
  }
  const OpticalInertialFilter filter = RunTo(scene, scene.rows());
  EXPECT_NEAR(filter.state().errors.gyro_delay_s, 0.005, 5e-4);
}

TEST(OpticalInertialFilterTest, IsConsistentOnSimulatedMotion) {
  // Mean NEES of the marker position and mean NIS, both 3 for a filter that knows its errors.
  double nees = 0.0;
  double nis = 0.0;
  int n = 0;
  int m = 0;
  for (unsigned seed = 1; seed <= 4; ++seed) {
    OpticalSceneConfig config = NoisyHand();
    config.seed = seed;
    config.motion_s = 12.0;
    OpticalScene scene(config);
    scene.Hide(scene.first_moving_row + 1600, scene.first_moving_row + 1700);
    OpticalInertialConfig tuned;  // the simulated sensor is ideal but for noise and bias
    tuned.sigma_accel_m_s2_rthz = 0.03 / std::sqrt(200.0);
    tuned.sigma_gyro_rad_s_rthz = 0.002 / std::sqrt(200.0);
    tuned.k_accel = tuned.k_rate = 1e-3;
    tuned.k_accel_bend = tuned.k_rate_bend = 0.05;
    tuned.sigma_marker_time_s = 0.0;
    OpticalInertialFilter filter(tuned);
    for (std::size_t row = 0; row < scene.rows(); ++row) {
      if (!FeedRow(filter, scene, row).epoch_closed || row < scene.first_moving_row + 1200) {
        continue;
      }
      const PositionEstimate estimate = ForwardEstimate(filter.epoch());
      const Vector3d e = estimate.p_earth_marker_m - scene.p_earth_marker_m[row];
      nees += e.dot(estimate.cov_position_m2.ldlt().solve(e));
      ++n;
      if (filter.epoch().had_marker) {
        nis += filter.epoch().nis;
        ++m;
      }
    }
  }
  EXPECT_GT(nees / n, 1.2);
  EXPECT_LT(nees / n, 6.0);
  EXPECT_GT(nis / m, 2.0);
  EXPECT_LT(nis / m, 4.0);
}

TEST(OpticalInertialFilterTest, GrowsCovarianceThroughAGapAndComesBack) {
  OpticalScene scene(NoisyHand());
  const std::size_t from = scene.first_moving_row + 2000;
  scene.Hide(from, from + 200);
  OpticalInertialFilter filter = RunTo(scene, from);
  const double before_m = ForwardEstimate(filter.epoch()).sigma_position_m();
  for (std::size_t row = from; row < from + 200; ++row) {
    (void)FeedRow(filter, scene, row);
  }
  const PositionEstimate end = ForwardEstimate(filter.epoch());
  EXPECT_EQ(end.fill, FillKind::kInertialForward);
  EXPECT_GT(end.sigma_position_m(), 10.0 * before_m);
  EXPECT_LT(ErrorAt_m(filter, scene), 3.0 * end.sigma_position_m());
  for (std::size_t row = from + 200; row < from + 220; ++row) {
    (void)FeedRow(filter, scene, row);
  }
  EXPECT_LT(ErrorAt_m(filter, scene), 1e-3);
  EXPECT_EQ(ForwardEstimate(filter.epoch()).fill, FillKind::kMeasured);
}

TEST(OpticalInertialFilterTest, AGhostHardlyMovesItAndItRecovers) {
  OpticalScene scene(NoisyHand());
  const std::size_t from = scene.first_moving_row + 2000;
  for (std::size_t row = from; row < from + 80; ++row) {  // 0.4 s
    scene.markers[row].p_earth_marker_m = Vector3d(2.0, 1.0, 0.5 + 1e-6 * static_cast<double>(row));
  }
  OpticalInertialFilter filter = RunTo(scene, from);
  double worst_m = 0.0;
  for (std::size_t row = from; row < from + 80; ++row) {
    (void)FeedRow(filter, scene, row);
    worst_m = std::max(worst_m, ErrorAt_m(filter, scene));
  }
  EXPECT_LT(worst_m, 0.1);
  EXPECT_GT(filter.marker_counters()[MarkerVerdict::kOutlier], 10U);
  EXPECT_GT(filter.marker_counters()[MarkerVerdict::kForeign], 10U);
  for (std::size_t row = from + 80; row < from + 200; ++row) {
    (void)FeedRow(filter, scene, row);
  }
  EXPECT_LT(ErrorAt_m(filter, scene), 3e-3);
}

TEST(OpticalInertialFilterTest, IsNeverLockedOut) {
  // The filter is put 1 m and 1 m/s away from the truth with a covariance that says millimetres.
  OpticalSceneConfig config = NoisyHand();
  config.motion_s = 26.0;
  const OpticalScene scene(config);
  const std::size_t from = scene.first_moving_row + 2000;
  OpticalInertialFilter filter = RunTo(scene, from);
  OpticalInertialState wrong = filter.state();
  wrong.navigation.p_earth_sensor_m += Vector3d(1.0, 0.0, 0.0);
  wrong.navigation.v_earth_sensor_m_s += Vector3d(0.0, 1.0, 0.0);
  OpticalInertialConfig sure;
  sure.sigma_start_p_m = sure.sigma_start_v_m_s = 1e-3;
  OpticalInertialFilter lost(sure);
  lost.Start(filter.at(), wrong);
  std::size_t row = from;
  for (; row < scene.rows(); ++row) {
    (void)FeedRow(lost, scene, row);
  }
  EXPECT_TRUE(lost.started());
  EXPECT_LT(ErrorAt_m(lost, scene), 5e-3);
}

TEST(OpticalInertialFilterTest, WhatIsNotEstimatedStaysAsGiven) {
  OpticalInertialConfig config;
  config.estimate_lever_arm = config.estimate_gravity = config.estimate_time_offset = false;
  config.estimate_calibration = config.estimate_gyro_delay = false;
  config.lever_arm_x_m = 0.01;
  config.marker_lead_s = 0.002;
  OpticalInertialFilter filter(config);
  const OpticalScene scene(NoisyHand());
  for (std::size_t row = 0; row < scene.rows(); ++row) {
    (void)FeedRow(filter, scene, row);
  }
  ASSERT_TRUE(filter.started());
  EXPECT_EQ(filter.state().p_sensor_marker_m, Vector3d(0.01, 0.0, 0.0));
  EXPECT_EQ(filter.state().marker_lead_s, 0.002);
  EXPECT_EQ(filter.state().g_in_earth_m_s2, Vector3d(0.0, 0.0, -9.81));
  EXPECT_EQ(filter.state().errors.accel_matrix, Eigen::Matrix3d::Zero());
  EXPECT_EQ(filter.covariance_rebuilds(), 0U);
}

}  // namespace
}  // namespace limbcast::filters
