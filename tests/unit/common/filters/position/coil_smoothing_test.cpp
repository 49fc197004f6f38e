#include "common/filters/position/coil_smoothing.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "common/math/rotation.hpp"
#include "tests/unit/common/filters/position/coil_scene.hpp"

namespace limbcast::filters {
namespace {

double Error2_m2(const CoilEstimate& estimate, const simulation::CoilTick& tick) {
  return (estimate.p_emitter_sensor_m - tick.p_emitter_sensor_m).squaredNorm();
}

TEST(CoilSmoothingTest, ALagHelpsAndTheWholeRecordingHelpsMore) {
  const auto ticks = SwingingSensor(true, simulation::ThesisPulses(), 20.0, 1);
  auto filter = CoilInertialFilter::Make(SwingConfig());
  ASSERT_TRUE(filter);
  CoilFixedLag fixed_lag(0.6, 120.0);
  CoilIntervalSmoother smoother;
  double forward = 0.0;
  double lagged = 0.0;
  double smoothed = 0.0;
  double smoothed_nees = 0.0;
  for (std::size_t k = 0; k < ticks.size(); ++k) {
    const Time at = ticks[k].frame.measured_at;
    filter->Update(ticks[k].frame);
    smoother.Add(*filter, at);
    CoilEstimate estimate;
    const bool has = fixed_lag.Update(*filter, at, estimate);
    if (k >= 672) {
      ASSERT_TRUE(has);
      EXPECT_EQ(estimate.measured_at, ticks[k - 72].frame.measured_at);
      lagged += Error2_m2(estimate, ticks[k - 72]);
      forward += (filter->state().p_emitter_sensor_m() - ticks[k].p_emitter_sensor_m).squaredNorm();
    }
  }
  const auto all = smoother.Smooth();
  ASSERT_EQ(all.size(), ticks.size());
  for (std::size_t k = 600; k + 72 < ticks.size(); ++k) {
    ASSERT_TRUE(all[k].valid);
    smoothed += Error2_m2(all[k], ticks[k]);
    smoothed_nees += Error2_m2(all[k], ticks[k]) / (all[k].sigma_m * all[k].sigma_m);
  }
  EXPECT_LT(lagged, 0.5 * forward);
  EXPECT_LT(smoothed, lagged);
  EXPECT_LT(smoothed_nees / static_cast<double>(ticks.size() - 672), 2.0);
}

TEST(CoilSmoothingTest, FixedLagIsTheIntervalSmootherOfWhatIsKnownThen) {
  const auto ticks = SwingingSensor(true, simulation::ThesisPulses(), 6.0, 2);
  auto filter = CoilInertialFilter::Make(SwingConfig());
  ASSERT_TRUE(filter);
  CoilFixedLag fixed_lag(0.6, 120.0);
  CoilIntervalSmoother smoother;
  CoilEstimate lagged;
  for (const auto& tick : ticks) {
    filter->Update(tick.frame);
    smoother.Add(*filter, tick.frame.measured_at);
    fixed_lag.Update(*filter, tick.frame.measured_at, lagged);
  }
  const auto all = smoother.Smooth();
  const CoilEstimate& same = all[all.size() - 1 - 72];
  EXPECT_EQ(same.measured_at, lagged.measured_at);
  EXPECT_LT((same.p_emitter_sensor_m - lagged.p_emitter_sensor_m).norm(), 1e-9);
  EXPECT_LT(math::AngleBetween_rad(same.q_sensor_emitter, lagged.q_sensor_emitter), 1e-7);
}

TEST(CoilSmoothingTest, NothingGoesBackPastALoss) {
  const auto ticks = SwingingSensor(true, simulation::ThesisPulses(), 12.0, 3);
  auto filter = CoilInertialFilter::Make(SwingConfig());
  ASSERT_TRUE(filter);
  CoilIntervalSmoother smoother;
  for (std::size_t k = 0; k < ticks.size(); ++k) {
    if (k == 800) {
      CoilVector kick = CoilVector::Zero();
      kick.head<3>() = Eigen::Vector3d(0.5, -0.5, 0.3);
      filter->Disturb(kick);
    }
    filter->Update(ticks[k].frame);
    smoother.Add(*filter, ticks[k].frame.measured_at);
  }
  ASSERT_GE(filter->losses(), 1);
  const auto all = smoother.Smooth();
  for (std::size_t k = 600; k < 700; ++k) {
    EXPECT_LT(Error2_m2(all[k], ticks[k]), 0.02 * 0.02);
  }
  EXPECT_LT(Error2_m2(all.back(), ticks.back()), 0.03 * 0.03);
}

}  // namespace
}  // namespace limbcast::filters
