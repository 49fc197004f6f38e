// The rows of design/position.md section 13 that concern optics and inertial readings, on the whole
// filter; inertial_gate_test and marker_gate_test look at the rules one by one.
#include <gtest/gtest.h>

#include <functional>
#include <limits>

#include "common/filters/position/fixed_lag_position.hpp"
#include "tests/support/allocation_counter.hpp"
#include "tests/unit/common/filters/position/optical_scene.hpp"

namespace limbcast::filters {
namespace {

using Eigen::Vector3d;
using test_support::FeedRow;
using test_support::OpticalScene;
using test_support::OpticalSceneConfig;

constexpr float kNan = std::numeric_limits<float>::quiet_NaN();

class OpticalBadInputTest : public ::testing::Test {
 protected:
  OpticalBadInputTest() : scene(Config()), row(scene.first_moving_row + 2000) {}

  static OpticalSceneConfig Config() {
    OpticalSceneConfig config;
    config.gyro_noise_rad_s = 0.002;
    config.accel_noise_m_s2 = 0.03;
    config.marker_noise_m = 1.5e-4;
    config.motion_s = 16.0;
    return config;
  }
  void FeedUntil(std::size_t until) {
    for (; fed < until; ++fed) {
      const OpticalStep step = FeedRow(filter, scene, fed);
      degraded = degraded || (step.epoch_closed && filter.epoch().degraded);
      ASSERT_TRUE(filter.state().navigation.p_earth_sensor_m.allFinite());
    }
  }
  [[nodiscard]] double Error_m() const {
    const std::size_t at = scene.RowOf(filter.epoch().at);
    return (ForwardEstimate(filter.epoch()).p_earth_marker_m - scene.p_earth_marker_m[at]).norm();
  }
  [[nodiscard]] double Sigma_m() const {
    return ForwardEstimate(filter.epoch()).sigma_position_m();
  }

  OpticalScene scene;
  std::size_t row;  // where the bad input begins: in motion, converged
  OpticalInertialFilter filter{OpticalInertialConfig{}};
  std::size_t fed = 0;
  bool degraded = false;
};

TEST_F(OpticalBadInputTest, MissingOpticalSamplesGrowTheCovariance) {
  for (std::size_t i = row; i < row + 40; ++i) {
    scene.markers[i].p_earth_marker_m.x() = std::numeric_limits<double>::quiet_NaN();
  }
  FeedUntil(row);
  const double before_m = Sigma_m();
  FeedUntil(row + 40);
  EXPECT_GT(Sigma_m(), 1.2 * before_m);
  EXPECT_EQ(filter.marker_counters()[MarkerVerdict::kHidden], 40U);
  FeedUntil(row + 80);
  EXPECT_LT(Error_m(), 1e-3);
}

TEST_F(OpticalBadInputTest, LeadingMissingSamplesAreWaitedFor) {
  scene.Hide(0, scene.first_moving_row + 600);
  FeedUntil(scene.first_moving_row + 600);
  EXPECT_FALSE(filter.started());
  FeedUntil(scene.rows());
  EXPECT_TRUE(filter.started());
  EXPECT_LT(Error_m(), 2e-3);
}

TEST_F(OpticalBadInputTest, RepeatedTripletsCountAsMissing) {
  for (std::size_t i = row; i < row + 40; ++i) {
    scene.markers[i].p_earth_marker_m = scene.markers[row].p_earth_marker_m;
  }
  FeedUntil(row + 40);
  EXPECT_EQ(filter.marker_counters()[MarkerVerdict::kRepeated], 38U);
  EXPECT_LT(Error_m(), 0.01);
}

TEST_F(OpticalBadInputTest, ShortInertialDropoutIsBridged) {
  for (std::size_t i = row; i < row + 8; ++i) {  // 40 ms at 200 Hz
    scene.samples[i].gyro_rad_s.x() = kNan;
  }
  FeedUntil(row);
  EXPECT_FALSE(degraded);
  FeedUntil(row + 60);
  EXPECT_TRUE(degraded);
  EXPECT_EQ(filter.inertial_counters()[SampleVerdict::kPredictedOnly], 8U);
  EXPECT_LT(Error_m(), 2e-3);
}

TEST_F(OpticalBadInputTest, LongInertialDropoutResetsTheVelocityAndIsFlagged) {
  FeedUntil(row);
  for (std::size_t i = row; i < row + 60; ++i) {  // 0.3 s
    scene.samples[i].accel_m_s2.z() = kNan;
  }
  FeedUntil(row + 61);
  EXPECT_TRUE(degraded);
  EXPECT_GT(std::sqrt(filter.epoch().P(optical::kV, optical::kV)), 0.9);
  EXPECT_LT(Error_m(), 3.0 * Sigma_m());
  FeedUntil(row + 400);
  EXPECT_LT(Error_m(), 3e-3);
  EXPECT_EQ(filter.restarts(), 0U);
}

TEST_F(OpticalBadInputTest, InertialReadingsThatStayAwayStartAnew) {
  FeedUntil(row);
  for (std::size_t i = row; i < row + 300; ++i) {
    scene.samples[i].accel_m_s2.z() = kNan;
  }
  FeedUntil(scene.rows());
  EXPECT_EQ(filter.restarts(), 1U);
}

TEST_F(OpticalBadInputTest, TimeGoingBackDropsTheSample) {
  FeedUntil(row);
  const OpticalInertialState before = filter.state();
  sensing::MargSample old = scene.samples[row - 10];
  EXPECT_EQ(filter.AddInertial(old).verdict, SampleVerdict::kRejectedOutOfOrder);
  EXPECT_EQ(filter.AddInertial(scene.samples[row - 1]).verdict, SampleVerdict::kRejectedDuplicate);
  EXPECT_EQ(filter.AddMarker(scene.markers[row - 10]), MarkerVerdict::kOutOfOrder);
  EXPECT_EQ(filter.state().navigation.p_earth_sensor_m, before.navigation.p_earth_sensor_m);
}

TEST_F(OpticalBadInputTest, SaturationRaisesTheNoiseOfItsBlock) {
  const auto sigma_after = [&](bool saturated) {
    OpticalScene changed = scene;
    changed.Hide(row, row + 20);
    if (saturated) {
      for (std::size_t i = row; i < row + 10; ++i) {
        changed.samples[i].flags |= sensing::kAccelSaturated | sensing::kGyroSaturated;
      }
    }
    OpticalInertialFilter own{OpticalInertialConfig{}};
    for (std::size_t i = 0; i < row + 20; ++i) {
      (void)FeedRow(own, changed, i);
    }
    return ForwardEstimate(own.epoch()).sigma_position_m();
  };
  EXPECT_GT(sigma_after(true), 3.0 * sigma_after(false));
}

TEST_F(OpticalBadInputTest, ANonFiniteStateStartsAnew) {
  FeedUntil(row);
  OpticalInertialState broken = filter.state();
  broken.navigation.v_earth_sensor_m_s.x() = std::numeric_limits<double>::quiet_NaN();
  filter.Start(filter.at(), broken);
  for (int i = 0; i < 4; ++i, ++fed) {
    (void)FeedRow(filter, scene, fed);
  }
  EXPECT_FALSE(filter.started());
  EXPECT_EQ(filter.restarts(), 1U);
}

TEST_F(OpticalBadInputTest, ACovarianceThatIsNotPositiveIsRebuilt) {
  // A marker noise far below what doubles resolve beside metres drives variances to zero.
  OpticalInertialConfig config;
  config.sigma_marker_m = 1e-12;
  config.sigma_marker_time_s = 0.0;
  config.estimate_lever_arm = config.estimate_time_offset = false;
  OpticalInertialFilter own(config);
  for (std::size_t i = 0; i < row; ++i) {
    (void)FeedRow(own, scene, i);
  }
  EXPECT_TRUE(own.started());
  EXPECT_GT(own.covariance_rebuilds(), 0U);
  EXPECT_TRUE(own.state().navigation.p_earth_sensor_m.allFinite());
  EXPECT_GE(own.epoch().P.diagonal().minCoeff(), 0.0);
}

TEST_F(OpticalBadInputTest, AllocatesNothingAfterConstruction) {
  scene.Hide(row, row + 100);
  scene.samples[row + 5].gyro_rad_s.x() = kNan;
  FixedLagPosition lag{OpticalInertialConfig{}};
  const std::size_t before = test_support::AllocationCount();
  int estimates = 0;
  for (std::size_t i = 0; i < scene.rows(); ++i) {
    if (FeedRow(filter, scene, i).epoch_closed) {
      lag.Push(filter.epoch());
      estimates += lag.has_estimate() ? 1 : 0;
    }
  }
  EXPECT_EQ(test_support::AllocationCount(), before);
  EXPECT_GT(estimates, 1000);
}

}  // namespace
}  // namespace limbcast::filters
