#include "common/filters/position/inertial_mechanisation.hpp"

#include <gtest/gtest.h>

#include <numbers>

#include "common/math/rotation.hpp"
#include "tests/unit/common/filters/position/optical_scene.hpp"

namespace limbcast::filters {
namespace {

using Eigen::Vector3d;
const Vector3d kGravity(0.0, 0.0, -9.81);

TEST(InertialMechanisationTest, ConstantAccelerationIsExact) {
  NavigationState state;
  state.v_earth_sensor_m_s = {1.0, 0.0, 0.0};
  InertialBlock block;
  const InertialReading reading{Vector3d::Zero(), Vector3d(2.0, 0.0, 9.81)};
  for (int i = 0; i < 100; ++i) {
    const Vector3d a = AdvanceInertial(reading, reading, 0.01, {}, kGravity, state, block);
    EXPECT_NEAR((a - Vector3d(2.0, 0.0, 0.0)).norm(), 0.0, 1e-12);
  }
  EXPECT_NEAR((state.p_earth_sensor_m - Vector3d(2.0, 0.0, 0.0)).norm(), 0.0, 1e-9);
  EXPECT_NEAR((state.v_earth_sensor_m_s - Vector3d(3.0, 0.0, 0.0)).norm(), 0.0, 1e-9);
  EXPECT_NEAR(block.dt_s, 1.0, 1e-12);
  EXPECT_EQ(block.steps, 100);
  EXPECT_NEAR((block.sum_accel_raw - Vector3d(2.0, 0.0, 9.81)).norm(), 0.0, 1e-9);
}

TEST(InertialMechanisationTest, ARateThatChangesItsAxisIsFollowedToFourthOrder) {
  // w(t) linear over the step: against 1000 small steps. Without the Magnus term it is 60 times
  // worse.
  const Vector3d w0(20.0, 0.0, 5.0);
  const Vector3d w1(18.0, 6.0, 5.0);
  constexpr double kDt = 0.005;
  Eigen::Quaterniond fine = Eigen::Quaterniond::Identity();
  for (int i = 0; i < 1000; ++i) {
    const double u = (i + 0.5) / 1000.0;
    fine = fine * math::ExpSO3(((1.0 - u) * w0 + u * w1) * (kDt / 1000.0));
  }
  NavigationState state;
  InertialBlock block;
  AdvanceInertial({w0, Vector3d::Zero()}, {w1, Vector3d::Zero()}, kDt, {}, kGravity, state, block);
  EXPECT_LT(math::AngleBetween_rad(state.q_earth_sensor, fine), 2e-6);
}

TEST(InertialMechanisationTest, TakesSensorErrorsOff) {
  InertialErrors errors;
  errors.accel_bias_m_s2 = {0.1, -0.2, 0.3};
  errors.gyro_bias_rad_s = {0.01, 0.02, -0.03};
  errors.accel_matrix << 0.01, 0.002, 0, -0.003, 0.005, 0, 0, 0.001, -0.01;
  errors.gyro_matrix << -0.01, 0, 0.004, 0, 0.01, 0, 0.002, 0, 0;
  test_support::OpticalSceneConfig config;
  config.motion_s = 3.0;
  config.rest_s = 1.0;
  config.rate_hz = 1000.0;
  config.errors = errors;
  const test_support::OpticalScene scene(config);
  NavigationState state = scene.truth[0];
  InertialBlock block;
  for (std::size_t i = 1; i < scene.rows(); ++i) {
    const auto reading = [&](std::size_t row) {
      return InertialReading{scene.samples[row].gyro_rad_s.cast<double>(),
                             scene.samples[row].accel_m_s2.cast<double>()};
    };
    AdvanceInertial(reading(i - 1), reading(i), 1e-3, errors, kGravity, state, block);
  }
  EXPECT_LT((state.p_earth_sensor_m - scene.truth.back().p_earth_sensor_m).norm(), 1e-3);
  EXPECT_LT(math::AngleBetween_rad(state.q_earth_sensor, scene.truth.back().q_earth_sensor), 1e-4);
}

}  // namespace
}  // namespace limbcast::filters
