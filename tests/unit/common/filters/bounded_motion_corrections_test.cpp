#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <limits>

#include "common/filters/bounded_motion_core.hpp"
#include "common/math/rotation.hpp"

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

// Turns about all axes in a field that lies; gravity and bounds are out of the way, so that
// whatever is learned comes from the magnetometer.
Core TurnInALyingField(BoundedMotionConfig config, bool mag_valid) {
  config.velocity_bound_m_s_rts = std::numeric_limits<double>::infinity();
  config.position_bound_m_rts = std::numeric_limits<double>::infinity();
  Core core(config);
  core.Start(Eigen::Quaterniond::Identity(), Eigen::Vector3d(0.0, 0.4, -0.9), false);
  Core::Input input;
  input.dt_s = 0.01;
  input.accel_valid = false;
  input.mag_valid = mag_valid;
  Eigen::Quaterniond q_ES = Eigen::Quaterniond::Identity();
  for (int i = 0; i < 2000; ++i) {
    const double t = 0.01 * i;
    input.gyro_rad_s = Eigen::Vector3d(2.0 * std::sin(t), 1.5 * std::cos(0.7 * t), 1.0);
    q_ES = q_ES * math::ExpSO3(input.gyro_rad_s * input.dt_s);
    input.mag = q_ES.conjugate() * Eigen::Vector3d(0.15, 0.37, -0.9);
    core.Update(input);
  }
  return core;
}

TEST(BoundedMotionCorrectionsTest, TheMagnetometerTeachesTheGyroOnlyWhenItMay) {
  BoundedMotionConfig config;
  const Core considered = TurnInALyingField(config, true);
  EXPECT_EQ(considered.state().b_g.norm(), 0.0);
  EXPECT_EQ(considered.state().S.norm(), 0.0);
  config.mag_heading_only = false;
  const Core taught = TurnInALyingField(config, true);
  EXPECT_GT(taught.state().S.norm(), 1e-5);
  EXPECT_GT(taught.state().b_g.norm(), 1e-5);
}

// Schmidt: what is considered stays as uncertain as it was, heading does not, and the whole stays a
// covariance.
TEST(BoundedMotionCorrectionsTest, ConsideredStatesKeepTheirCovariance) {
  const State with = TurnInALyingField(BoundedMotionConfig(), true).state();
  const State without = TurnInALyingField(BoundedMotionConfig(), false).state();
  EXPECT_LT((with.P.Full().block<3, 3>(3, 3) - without.P.Full().block<3, 3>(3, 3)).norm(), 1e-15);
  EXPECT_LT((with.P.Full().block<9, 9>(16, 16) - without.P.Full().block<9, 9>(16, 16)).norm(),
            1e-15);
  EXPECT_LT((with.P.Full().block<3, 9>(3, 16) - without.P.Full().block<3, 9>(3, 16)).norm(), 1e-15);
  EXPECT_LT(with.P(2, 2), 0.95 * without.P(2, 2));  // tilt, not known here, hides most of it
  const Eigen::Matrix<double, State::kDim, State::kDim> P = with.P.Full();
  EXPECT_LT((P - P.transpose()).norm(), 1e-9);
  EXPECT_GT(P.selfadjointView<Eigen::Lower>().eigenvalues().minCoeff(), -1e-12);
}

// The field turned about the vertical by `heading_rad(t)`: its length and dip are what they were.
template <typename HeadingOfTime>
double ScatterOfTurnedField(const HeadingOfTime& heading_rad) {
  Core core{BoundedMotionConfig()};
  core.Start(Eigen::Quaterniond::Identity(), Eigen::Vector3d(0.0, 0.4, -0.9), false);
  Core::Input input;
  input.dt_s = 0.01;
  input.gyro_rad_s.setZero();
  input.accel_valid = false;  // nobody can say that it is at rest
  for (int i = 0; i < 6000; ++i) {
    const double h = heading_rad(0.01 * i);
    input.mag = Eigen::Vector3d(0.4 * std::sin(h), 0.4 * std::cos(h), -0.9);
    core.Update(input);
  }
  EXPECT_LT(core.state().deviation_hold, 0.03);
  return std::sqrt(core.state().east_scatter2);
}

TEST(BoundedMotionCorrectionsTest, AFieldThatTurnsFromPlaceToPlaceScatters) {
  // ±20° in 6 s: 0.4 sin(20°)/√2 of a field of √(0.4² + 0.9²) is 0.098.
  const double scatter =
      ScatterOfTurnedField([](double t) { return 0.35 * std::sin(2.0 * 3.14159 / 6.0 * t); });
  EXPECT_GT(scatter, 0.07);
  EXPECT_LT(scatter, 0.11);
}

TEST(BoundedMotionCorrectionsTest, AWrongHeadingDoesNotScatter) {
  EXPECT_LT(ScatterOfTurnedField([](double) { return 0.1; }),
            0.5 * BoundedMotionConfig().scatter_floor_ref);
}

TEST(BoundedMotionCorrectionsTest, AtRestTheSamePlaceIsNoScatter) {
  Core core{BoundedMotionConfig()};
  core.Start(Eigen::Quaterniond::Identity(), Eigen::Vector3d(0.0, 0.4, -0.9), false);
  Core::Input input = RestInput(0.01);
  for (int i = 0; i < 200; ++i) {
    core.Update(input);
  }
  ASSERT_TRUE(core.at_rest());
  const double before = core.state().east_scatter2;
  input.mag.x() = 0.3;
  for (int i = 0; i < 500; ++i) {
    core.Update(input);
  }
  EXPECT_EQ(core.state().east_scatter2, before);
}

// Somebody who turns by 0.2 °/s for a few seconds looks at rest; a known bias must survive it.
TEST(BoundedMotionCorrectionsTest, ASlowTurnIsNotTakenForABiasOnceThatIsKnown) {
  const auto bias_error_after_turn = [](double persistence_s) {
    BoundedMotionConfig config;
    config.rest_turn_persistence_s = persistence_s;
    Core core(config);
    core.Start(Eigen::Quaterniond::Identity(), Eigen::Vector3d(0.0, 0.4, -0.9), false);
    Core::Input input = RestInput(0.01);
    for (int i = 0; i < 1000; ++i) {
      core.Update(input);
    }
    const Eigen::Vector3d bias_rad_s = input.gyro_rad_s;
    input.gyro_rad_s.z() += 0.0035;
    input.mag_valid = false;
    for (int i = 0; i < 300; ++i) {
      core.Update(input);
    }
    EXPECT_TRUE(core.at_rest());
    return (core.state().b_g - bias_rad_s).norm();
  };
  const double plain = bias_error_after_turn(0.0);
  EXPECT_GT(plain, 0.0005);
  EXPECT_LT(bias_error_after_turn(1.0), 0.25 * plain);
}

// Walking away for 20 s at 1 m/s: the position bound must not make that a tilt.
TEST(BoundedMotionCorrectionsTest, WalkingAwayTiltsLessWithPersistence) {
  const auto tilt_rad = [](double persistence_s) {
    BoundedMotionConfig config;
    config.position_persistence_s = persistence_s;
    Core core(config);
    core.Start(Eigen::Quaterniond::Identity(), Eigen::Vector3d(0.0, 0.4, -0.9), false);
    Core::Input input = RestInput(0.01);
    input.gyro_rad_s.setZero();
    double worst_rad = 0.0;
    for (int i = 0; i < 3000; ++i) {
      input.rest_allowed = i < 1000;
      input.accel_m_s2.x() = i >= 1000 && i < 1050 ? 2.0 : 0.0;
      core.Update(input);
      const Eigen::Vector3d up_E = core.state().q_ES * Eigen::Vector3d::UnitZ();
      worst_rad = std::max(worst_rad, std::acos(std::min(1.0, up_E.z())));
    }
    return worst_rad;
  };
  EXPECT_LT(tilt_rad(2.0), 0.9 * tilt_rad(0.0));
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
