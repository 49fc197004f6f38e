#include <gtest/gtest.h>

#include "common/filters/bounded_motion_core.hpp"

namespace limbcast::filters {
namespace {

using Core = BoundedMotionCore<double>;
using State = Core::State;

Core::Input RestInput(double dt_s) {
  Core::Input input;
  input.dt_s = dt_s;
  input.gyro_rad_s = Eigen::Vector3d(0.004, -0.003, 0.002);
  input.accel_m_s2 = Eigen::Vector3d(0.0, 0.0, 9.81);
  input.mag = Eigen::Vector3d(0.0, 0.4, -0.9);
  return input;
}

TEST(BoundedMotionCorrectionsTest, RestTeachesTheGyroBias) {
  Core core{BoundedMotionConfig()};
  core.Start(Eigen::Quaterniond::Identity(), Eigen::Vector3d(0.0, 0.4, -0.9), false);
  for (int i = 0; i < 1000; ++i) {
    core.Update(RestInput(0.01));
  }
  EXPECT_TRUE(core.at_rest());
  EXPECT_LT((core.state().b_g - RestInput(0.01).gyro_rad_s).norm(), 1e-4);
  EXPECT_LT(core.state().v_h.norm(), 1e-3);
}

TEST(BoundedMotionCorrectionsTest, TheMagnetometerTurnsHeadingAndNeverTilts) {
  Core core{BoundedMotionConfig()};
  core.Start(Eigen::Quaterniond::Identity(), Eigen::Vector3d(0.0, 0.4, -0.9), false);
  Core::Input input = RestInput(0.01);
  input.gyro_rad_s.setZero();
  input.mag = Eigen::Vector3d(0.1, 0.38, -0.9);  // the field turned by 15 degrees
  for (int i = 0; i < 3000; ++i) {
    core.Update(input);
  }
  const Eigen::Vector3d up_E = core.state().q_ES * Eigen::Vector3d::UnitZ();
  EXPECT_GT(up_E.z(), 1.0 - 1e-6);
  EXPECT_GT(core.state().q_ES.z(), 0.03);
}

TEST(BoundedMotionCorrectionsTest, AnUnsoundCovarianceIsReplacedAndCounted) {
  Core core{BoundedMotionConfig()};
  core.Start(Eigen::Quaterniond::Identity(), Eigen::Vector3d(0.0, 0.4, -0.9), false);
  core.mutable_state().P(4, 4) = -1.0;
  for (int i = 0; core.state().slow_steps < 2; ++i) {
    core.Update(RestInput(0.01));
  }
  EXPECT_EQ(core.state().covariance_resets, 1U);
  for (int i = 0; i < State::kDim; ++i) {
    EXPECT_GE(core.state().P(i, i), 0.0);
  }
}

}  // namespace
}  // namespace limbcast::filters
