#include "common/filters/bounded_motion_core.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "common/math/rotation.hpp"

namespace limbcast::filters {
namespace {

using Core = BoundedMotionCore<double>;
using State = Core::State;

BoundedMotionConfig WithoutCorrections() {
  BoundedMotionConfig config;
  config.slow_rate_hz = 100.0;
  config.velocity_bound_m_s_rts = std::numeric_limits<double>::infinity();
  config.position_bound_m_rts = std::numeric_limits<double>::infinity();
  return config;
}

Core::Input MovingInput(double dt_s, int i) {
  Core::Input input;
  input.dt_s = dt_s;
  input.gyro_rad_s = Eigen::Vector3d(2.0, -1.5 + 0.05 * i, 0.8);
  input.accel_m_s2 = Eigen::Vector3d(3.0, -1.0 + 0.1 * i, 9.0);
  input.mag_valid = false;
  return input;
}

// truth = estimate ⊞ error, in the convention of the header
void InjectError(State& s, int index, double h) {
  if (index < 3) {
    Eigen::Vector3d phi = Eigen::Vector3d::Zero();
    phi[index] = h;
    s.q_ES = math::ExpSO3(phi) * s.q_ES;
  } else if (index < 6) {
    s.b_g[index - 3] += h;
  } else if (index < 8) {
    s.v_h[index - 6] += h;
  } else if (index < 10) {
    s.p_h[index - 8] += h;
  } else if (index < 13) {
    s.b_a[index - 10] += h;
  } else if (index < 16) {
    s.b_m[index - 13] += h;
  } else if (index < 25) {
    s.S((index - 16) % 3, (index - 16) / 3) += h;
  } else {
    s.m_0[index - 24] += h;
  }
}

Eigen::Matrix<double, State::kDim, 1> ErrorBetween(const State& truth, const State& estimate) {
  Eigen::Matrix<double, State::kDim, 1> error;
  error.segment<3>(0) = math::LogSO3(truth.q_ES * estimate.q_ES.conjugate());
  error.segment<3>(3) = truth.b_g - estimate.b_g;
  error.segment<2>(6) = truth.v_h - estimate.v_h;
  error.segment<2>(8) = truth.p_h - estimate.p_h;
  error.segment<3>(10) = truth.b_a - estimate.b_a;
  error.segment<3>(13) = truth.b_m - estimate.b_m;
  for (int j = 0; j < 3; ++j) {
    error.segment<3>(16 + 3 * j) = truth.S.col(j) - estimate.S.col(j);
  }
  error.segment<2>(25) = (truth.m_0 - estimate.m_0).tail<2>();
  return error;
}

class BoundedMotionTransitionTest : public ::testing::TestWithParam<int> {};

// The covariance of a single unit error must become f·fᵀ, where f is what one slow step really
// makes of that error.
TEST_P(BoundedMotionTransitionTest, MatchesWhatTheStepDoesToASmallError) {
  const int index = GetParam();
  constexpr double kH = 1e-6;
  constexpr double kDt_s = 1.0 / 2000.0;
  Core estimate(WithoutCorrections());
  estimate.Start(math::ExpSO3({0.4, -0.3, 1.1}), Eigen::Vector3d(0.0, 0.4, -0.9), false);
  Core truth = estimate;
  InjectError(truth.mutable_state(), index, kH);
  estimate.mutable_state().P.SetZero();
  estimate.mutable_state().P(index, index) = 1.0;

  for (int i = 0; estimate.state().slow_steps == 0; ++i) {
    estimate.Update(MovingInput(kDt_s, i));
    truth.Update(MovingInput(kDt_s, i));
    ASSERT_LT(i, 100);
  }
  const Eigen::Matrix<double, State::kDim, 1> f =
      ErrorBetween(truth.state(), estimate.state()) / kH;
  const Eigen::Matrix<double, State::kDim, State::kDim> expected = f * f.transpose();
  const Eigen::Matrix<double, State::kDim, State::kDim> actual = estimate.state().P.Full();
  // F is of first order in the step T = 10 ms: what it leaves out is g·T²/2 = 5e-4 at the most.
  // design.
  EXPECT_LT((actual - expected).cwiseAbs().maxCoeff(), 1e-3) << "error state " << index << "\n"
                                                             << f.transpose();
}

INSTANTIATE_TEST_SUITE_P(EveryErrorState, BoundedMotionTransitionTest, ::testing::Range(0, 27));

TEST(BoundedMotionCoreTest, SinglePrecisionFollowsDoublePrecision) {
  Core wide{BoundedMotionConfig()};
  BoundedMotionCore<float> narrow{BoundedMotionConfig()};
  wide.Start(Eigen::Quaterniond::Identity(), Eigen::Vector3d(0.0, 0.4, -0.9), false);
  narrow.Start(Eigen::Quaternionf::Identity(), Eigen::Vector3f(0.0F, 0.4F, -0.9F), false);
  Eigen::Quaterniond q_truth = Eigen::Quaterniond::Identity();
  for (int i = 0; i < 10000; ++i) {
    const double t = 0.005 * i;
    const Eigen::Vector3d w(std::sin(1.3 * t), std::cos(0.9 * t), std::sin(0.7 * t + 1.0));
    q_truth = q_truth * math::ExpSO3(0.005 * w);
    Core::Input input;
    input.dt_s = 0.005;
    input.gyro_rad_s = w;
    input.accel_m_s2 = q_truth.conjugate() * Eigen::Vector3d(0.0, 0.0, 9.81);
    input.mag = q_truth.conjugate() * Eigen::Vector3d(0.0, 0.4, -0.9);
    wide.Update(input);
    BoundedMotionInput<float> input_f;
    input_f.dt_s = 0.005F;
    input_f.gyro_rad_s = input.gyro_rad_s.cast<float>();
    input_f.accel_m_s2 = input.accel_m_s2.cast<float>();
    input_f.mag = input.mag.cast<float>();
    narrow.Update(input_f);
  }
  EXPECT_LT(
      math::AngleBetween_rad(wide.state().q_ES, narrow.state().q_ES.cast<double>().normalized()),
      2e-4);
  EXPECT_LT(math::AngleBetween_rad(wide.state().q_ES, q_truth), 2e-3);
  EXPECT_EQ(wide.state().covariance_resets, 0U);
  EXPECT_EQ(narrow.state().covariance_resets, 0U);
}

}  // namespace
}  // namespace limbcast::filters
