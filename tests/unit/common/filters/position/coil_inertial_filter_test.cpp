#include "common/filters/position/coil_inertial_filter.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "common/math/rotation.hpp"
#include "tests/unit/common/filters/position/coil_scene.hpp"

namespace limbcast::filters {
namespace {

using simulation::CoilTick;
using Index = CoilInertialIndex;
using Ticks = std::vector<CoilTick>;

struct Outcome {
  double rms_m = 0.0;
  double rms_rad = 0.0;
  double nees = 0.0;  // of the position in the emitter frame, mean of 3
  double worst_m = 0.0;
  int tracked = 0;
  int losses = 0;
};

CoilInertialFilter MakeFilter(const CoilInertialConfig& config) {
  auto made = CoilInertialFilter::Make(config);
  EXPECT_TRUE(made);
  return *made;
}

double Error_m(const CoilInertialFilter& filter, const CoilTick& tick) {
  return (filter.state().p_emitter_sensor_m() - tick.p_emitter_sensor_m).norm();
}

Outcome Play(CoilInertialFilter filter, const Ticks& ticks, double scored_from_s) {
  Outcome outcome;
  for (const CoilTick& tick : ticks) {
    filter.Update(tick.frame);
    if (filter.phase() != CoilPhase::kTracking ||
        ToSeconds(tick.frame.measured_at.time_since_epoch()) < scored_from_s) {
      continue;
    }
    const double error_m = Error_m(filter, tick);
    const double error_rad =
        math::AngleBetween_rad(filter.state().q_sensor_emitter(), tick.q_sensor_emitter);
    ++outcome.tracked;
    outcome.rms_m += error_m * error_m;
    outcome.rms_rad += error_rad * error_rad;
    outcome.worst_m = std::max(outcome.worst_m, error_m);
    outcome.nees += error_m * error_m / filter.covariance().topLeftCorner<3, 3>().trace();
  }
  outcome.rms_m = std::sqrt(outcome.rms_m / outcome.tracked);
  outcome.rms_rad = std::sqrt(outcome.rms_rad / outcome.tracked);
  outcome.nees *= 3.0 / outcome.tracked;
  outcome.losses = filter.losses();
  return outcome;
}

TEST(CoilInertialFilterTest, TracksASensorFromAMovingSource) {
  const Ticks ticks = SwingingSensor(true, simulation::ThesisPulses(), 25.0, 1);
  const Outcome outcome = Play(MakeFilter(SwingConfig()), ticks, 5.0);
  EXPECT_EQ(outcome.tracked, 120 * 20);
  EXPECT_EQ(outcome.losses, 0);
  EXPECT_LT(outcome.rms_m, 0.007);
  EXPECT_LT(outcome.rms_rad, 0.0175);
  EXPECT_LT(outcome.nees, 6.0);
}

TEST(CoilInertialFilterTest, TracksASensorFromAFixedSourceWithoutInertialUnit) {
  const Ticks ticks = SwingingSensor(false, simulation::ThesisPulses(), 25.0, 2);
  const Outcome outcome = Play(MakeFilter(SwingConfig()), ticks, 5.0);
  EXPECT_EQ(outcome.tracked, 120 * 20);
  EXPECT_LT(outcome.rms_m, 0.007);
  EXPECT_LT(outcome.rms_rad, 0.0175);
}

// Turns that a sensor has whose axes are not square and of one scale, and whose gyro is late.
Ticks WithGyroErrors(Ticks ticks, const Eigen::Matrix3d& gain, double delay_s) {
  Eigen::Vector3d before = ticks.front().frame.gyro_rad_s;
  for (CoilTick& tick : ticks) {
    const Eigen::Vector3d now = tick.frame.gyro_rad_s;
    tick.frame.gyro_rad_s = gain * (now + delay_s * 120.0 * (before - now));
    before = now;
  }
  return ticks;
}

Eigen::Matrix3d SkewedGain() {
  Eigen::Matrix3d gain;
  gain << 1.02, 0.01, -0.015,  //
      -0.01, 0.98, 0.01,       //
      0.015, 0.02, 1.015;
  return gain;
}

TEST(CoilInertialFilterTest, LearnsTheMatrixOfTheGyro) {
  simulation::CoilStreamConfig stream = SwingStream(false, simulation::ThesisPulses());
  stream.errors.gyro.scale = stream.errors.gyro.misalignment = 0.0;  // SkewedGain() is all it has
  const Ticks ticks = WithGyroErrors(simulation::SimulateCoil(stream, 60.0, 9), SkewedGain(), 0.0);
  CoilInertialConfig config = SwingConfig();
  CoilInertialFilter filter = MakeFilter(config);
  const Outcome with = Play(filter, ticks, 30.0);
  config.estimate_calibration = false;
  const Outcome without = Play(MakeFilter(config), ticks, 30.0);
  EXPECT_LT(with.rms_m, 0.8 * without.rms_m);
  EXPECT_LT(with.nees, 6.0);
  for (const CoilTick& tick : ticks) {
    filter.Update(tick.frame);
  }
  // w = (I − M_g) w_m
  const Eigen::Matrix3d expected = Eigen::Matrix3d::Identity() - SkewedGain().inverse();
  const Eigen::Matrix3d left = filter.state().sensor.gyro_matrix - expected;
  EXPECT_LT(left.norm(), 0.4 * expected.norm());
  const auto var = filter.covariance().diagonal().segment<9>(Index::kSensorGyroMatrix);
  EXPECT_LT((left.reshaped().array().square() / var.array()).mean(), 3.0);
}

TEST(CoilInertialFilterTest, LearnsHowLateTheGyroIs) {
  constexpr double kDelay_s = 4e-3;
  const Ticks ticks = WithGyroErrors(SwingingSensor(false, simulation::ThesisPulses(), 60.0, 10),
                                     Eigen::Matrix3d::Identity(), kDelay_s);
  CoilInertialFilter filter = MakeFilter(SwingConfig());
  for (const CoilTick& tick : ticks) {
    filter.Update(tick.frame);
  }
  const double sigma_s =
      std::sqrt(filter.covariance()(Index::kSensorGyroDelay, Index::kSensorGyroDelay));
  EXPECT_LT(sigma_s, 1e-3);
  EXPECT_NEAR(filter.state().sensor.gyro_delay_s, kDelay_s, 3.0 * sigma_s);
}

TEST(CoilInertialFilterTest, WhatIsNotToBeEstimatedStays) {
  const Ticks ticks = SwingingSensor(true, simulation::ThesisPulses(), 12.0, 11);
  CoilInertialConfig config = SwingConfig();
  config.estimate_calibration = false;
  config.estimate_gyro_delay = false;
  config.estimate_gradient = false;
  CoilInertialFilter filter = MakeFilter(config);
  for (std::size_t k = 0; k < ticks.size(); ++k) {
    if (k == 900) {
      CoilVector kick = CoilVector::Zero();
      kick[Index::kP] = 2.0;
      filter.Disturb(kick);  // a loss widens much, but not this
    }
    filter.Update(ticks[k].frame);
  }
  ASSERT_EQ(filter.losses(), 1);
  EXPECT_EQ(filter.state().sensor.gyro_matrix, Eigen::Matrix3d::Zero());
  EXPECT_EQ(filter.state().sensor.accel_matrix, Eigen::Matrix3d::Zero());
  EXPECT_EQ(filter.state().sensor.gyro_delay_s, 0.0);
  EXPECT_EQ(filter.state().gradient_earth_tesla_m, Eigen::Matrix3d::Zero());
  EXPECT_EQ(filter.state().emitter_mag_offset_tesla, Eigen::Vector3d::Zero());
  constexpr int kRest = Index::kAll - Index::kSensorAccelMatrix;
  EXPECT_TRUE(filter.covariance().rightCols<kRest>().isZero(0.0));
}

TEST(CoilInertialFilterTest, ALossKeepsTheCalibrationThatWasLearned) {
  const Ticks ticks = SwingingSensor(true, simulation::ThesisPulses(), 20.0, 12);
  const CoilInertialConfig config = SwingConfig();
  CoilInertialFilter filter = MakeFilter(config);
  for (std::size_t k = 0; k < ticks.size() && filter.losses() == 0; ++k) {
    if (k == 2000) {
      CoilVector kick = CoilVector::Zero();
      kick[Index::kP] = 2.0;
      filter.Disturb(kick);
    }
    filter.Update(ticks[k].frame);
  }
  ASSERT_EQ(filter.losses(), 1);
  EXPECT_GT(filter.state().sensor.gyro_matrix.norm(), 0.0);
  const auto sigma = filter.covariance().diagonal().cwiseSqrt().eval();
  EXPECT_LT(sigma.segment<9>(Index::kSensorAccelMatrix).minCoeff(),
            0.8 * config.start_sigma_accel_matrix);
  EXPECT_LT(sigma.segment<9>(Index::kSensorGyroMatrix).minCoeff(),
            0.8 * config.start_sigma_gyro_matrix);
  EXPECT_LT(sigma[Index::kSensorGyroDelay], 0.8 * config.start_sigma_gyro_delay_s);
}

TEST(CoilInertialFilterTest, BipolarPulsesOfAThirdOfTheLengthAreEnough) {
  const Ticks ticks = SwingingSensor(true, simulation::BipolarPulses(), 15.0, 3);
  const Outcome outcome = Play(MakeFilter(SwingConfig()), ticks, 5.0);
  EXPECT_EQ(outcome.losses, 0);
  EXPECT_LT(outcome.rms_m, 0.01);
}

TEST(CoilInertialFilterTest, BadInputDoesNotThrowItOff) {
  Ticks ticks = SwingingSensor(true, simulation::ThesisPulses(), 15.0, 6);
  constexpr std::size_t kSpoiledFrom = 600;
  SpoilFrames(ticks, kSpoiledFrom);
  for (std::size_t k = kSpoiledFrom; k < ticks.size(); ++k) {
    sensing::CoilFrame& frame = ticks[k].frame;
    if (k % 301 == 0) {
      frame.mag_tesla += Eigen::Vector3d(3e-6, -2e-6, 1e-6);
    }
  }
  const Outcome outcome = Play(MakeFilter(SwingConfig()), ticks, 5.0);
  EXPECT_EQ(outcome.losses, 0);
  EXPECT_LT(outcome.rms_m, 0.012);
}

TEST(CoilInertialFilterTest, SaysWhatBecameOfAFrame) {
  const Ticks ticks = SwingingSensor(true, simulation::ThesisPulses(), 3.0, 7);
  CoilInertialFilter filter = MakeFilter(SwingConfig());
  for (const CoilTick& tick : ticks) {
    filter.Update(tick.frame);
  }
  ASSERT_EQ(filter.phase(), CoilPhase::kTracking);
  sensing::CoilFrame frame = ticks.back().frame;
  EXPECT_EQ(filter.Update(frame).verdict, CoilFrameVerdict::kRejectedOutOfOrder);
  frame.measured_at += std::chrono::milliseconds(8);
  frame.mag_valid = false;
  EXPECT_EQ(filter.Update(frame).verdict, CoilFrameVerdict::kInertialOnly);
  frame.measured_at += std::chrono::milliseconds(8);
  frame.gyro_rad_s.x() = std::numeric_limits<double>::infinity();
  EXPECT_EQ(filter.Update(frame).verdict, CoilFrameVerdict::kHeld);
}

TEST(CoilInertialFilterTest, AnEstimateThatIsNotFiniteBeginsAnew) {
  const Ticks ticks = SwingingSensor(true, simulation::ThesisPulses(), 8.0, 8);
  CoilInertialFilter filter = MakeFilter(SwingConfig());
  for (std::size_t k = 0; k < ticks.size(); ++k) {
    if (k == 400) {
      CoilVector broken = CoilVector::Zero();
      broken[0] = std::numeric_limits<double>::quiet_NaN();
      filter.Disturb(broken);
    }
    filter.Update(ticks[k].frame);
    EXPECT_TRUE(filter.state().IsFinite());
  }
}

}  // namespace
}  // namespace limbcast::filters
