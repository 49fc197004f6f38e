#include "common/filters/position/inertial_error_model.hpp"

#include <gtest/gtest.h>

#include "common/filters/position/optical_inertial_states.hpp"

namespace limbcast::filters {
namespace {

using namespace optical;
using Eigen::Vector3d;

// One block of several steps from a state and two readings that change.
OpticalInertialState RunBlock(OpticalInertialState x, InertialBlock& block) {
  block.Clear();
  constexpr int kSteps = 3;
  constexpr double kDt = 0.002;
  const InertialReading first{{2.0, -1.0, 3.0}, {3.0, -4.0, 11.0}};
  const InertialReading change{{0.2, 0.1, -0.1}, {0.5, 0.3, -0.6}};
  InertialReading before = first;
  for (int i = 0; i < kSteps; ++i) {
    const InertialReading now{before.gyro_rad_s + change.gyro_rad_s,
                              before.accel_m_s2 + change.accel_m_s2};
    AdvanceInertial(before, now, kDt, x.errors, x.g_in_earth_m_s2, x.navigation, block);
    before = now;
  }
  return x;
}

OpticalInertialState SomeState() {
  OpticalInertialState x;
  x.navigation.p_earth_sensor_m = {0.3, 0.2, 1.0};
  x.navigation.v_earth_sensor_m_s = {0.5, -1.0, 0.3};
  x.navigation.q_earth_sensor = math::ExpSO3({0.4, -0.7, 1.2});
  x.errors.accel_bias_m_s2 = {0.05, -0.02, 0.03};
  x.errors.gyro_bias_rad_s = {0.01, 0.02, -0.01};
  x.errors.accel_matrix(0, 1) = 0.01;
  x.errors.gyro_matrix(2, 0) = -0.01;
  return x;
}

TEST(InertialErrorModelTest, EveryColumnOfFAgreesWithDifferences) {
  const OpticalInertialState x = SomeState();
  InertialBlock block;
  const OpticalInertialState end = RunBlock(x, block);
  Transition F;
  F.top.setZero();
  AddInertialTransition(block, kInertial, 1.0, F.top);

  constexpr double kStep = 1e-4;
  const double D = block.dt_s;
  for (int column = 0; column < kStates; ++column) {
    InertialBlock ignored;
    OpticalInertialState plus = x;
    Inject(ErrorVector::Unit(column) * kStep, plus);
    OpticalInertialState minus = x;
    Inject(ErrorVector::Unit(column) * -kStep, minus);
    const ErrorVector difference =
        (Difference(RunBlock(plus, ignored), end) - Difference(RunBlock(minus, ignored), end)) /
        (2.0 * kStep);
    const ErrorVector predicted = F.Dense().col(column);
    // Position rows: to the second order in D as the model is, of accelerations up to 15 m/s².
    EXPECT_LT((difference - predicted).segment<3>(kP).norm(), 0.05 * 15.0 * 0.5 * D * D) << column;
    EXPECT_LT((difference - predicted).segment<3>(kV).norm(), 0.01 * 15.0 * D) << column;
    EXPECT_LT((difference - predicted).segment<3>(kTheta).norm(), 0.02 * 4.0 * D) << column;
    EXPECT_LT((difference - predicted).tail<kStates - kMoving>().norm(), 1e-9) << column;
  }
}

TEST(InertialErrorModelTest, ASourceThatIsSubtractedTurnsItsSigns) {
  InertialBlock block;
  (void)RunBlock(SomeState(), block);
  Transition plus;
  plus.top.setZero();
  AddInertialTransition(block, kInertial, 1.0, plus.top);
  Transition minus;
  minus.top.setZero();
  AddInertialTransition(block, kInertial, -1.0, minus.top);
  const auto block_of = [](const Transition& F, int row, int column) {
    return Eigen::Matrix3d(F.top.block<3, 3>(row, column));
  };
  EXPECT_EQ(block_of(minus, kV, kTheta), -block_of(plus, kV, kTheta));
  EXPECT_EQ(block_of(minus, kV, kAccelBias), -block_of(plus, kV, kAccelBias));
  EXPECT_EQ(block_of(minus, kP, kV), block_of(plus, kP, kV));
  EXPECT_EQ(block_of(minus, kTheta, kGyroBias), block_of(plus, kTheta, kGyroBias));
}

TEST(InertialErrorModelTest, NoiseIsWhatTheSpecificationSays) {
  InertialBlock block;
  (void)RunBlock(SomeState(), block);
  const double D = block.dt_s;
  InertialNoise noise;
  noise.k_accel_bend = 0.0;
  noise.k_rate_bend = 0.0;
  const Vector3d a(3.0, 0.0, 4.0);
  const InertialProcessNoise q = ProcessNoiseOf(block, noise, a, 1.0);
  const double w = block.sum_gyro_raw.norm() / D;
  // sa_eff² D with sa_eff² = sa² + (ka |a|)² D, and the same for the gyro.
  EXPECT_NEAR(q.var_v, (1e-4 + 0.05 * 0.05 * D) * D, 1e-15);
  EXPECT_NEAR(q.var_theta, (1e-6 + 0.003 * w * 0.003 * w * D) * D, 1e-15);
  EXPECT_NEAR(q.var_p, q.var_v * D * D / 3.0, 1e-18);
  EXPECT_NEAR(q.cov_pv, q.var_v * D / 2.0, 1e-18);
  EXPECT_NEAR(q.var_accel_bias, 1e-6 * D, 1e-15);
  EXPECT_NEAR(q.var_gyro_bias, 1e-8 * D, 1e-15);

  EXPECT_NEAR(ProcessNoiseOf(block, noise, a, 100.0).var_theta, 100.0 * q.var_theta, 1e-12);
  noise.k_accel_bend = 0.5;
  EXPECT_NEAR(ProcessNoiseOf(block, noise, a, 1.0).var_v, q.var_v + 0.25 * block.sum_accel_bend2,
              1e-15);

  Covariance P = Covariance::Zero();
  AddProcessNoise(q, kInertial, P);
  EXPECT_EQ(P, P.transpose());
  EXPECT_EQ(P(kP + 1, kV + 1), q.cov_pv);
  EXPECT_EQ(P.bottomRightCorner(kStates - kLever, kStates - kLever).norm(), 0.0);
}

}  // namespace
}  // namespace limbcast::filters
