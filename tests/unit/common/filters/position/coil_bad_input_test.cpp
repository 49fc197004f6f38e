// The rows of design/position.md section 13 that a coil filter meets, one test each; and that it
// allocates nothing.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "common/filters/position/coil_inertial_filter.hpp"
#include "common/filters/position/coil_smoothing.hpp"
#include "tests/support/allocation_counter.hpp"
#include "tests/unit/common/filters/position/coil_scene.hpp"

namespace limbcast::filters {
namespace {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

class CoilBadInputTest : public ::testing::Test {
 protected:
  CoilBadInputTest()
      : ticks_(SwingingSensor(true, simulation::ThesisPulses(), 14.0, 21)),
        filter_(*CoilInertialFilter::Make(SwingConfig())) {}

  // Plays frames until (not with) `row`.
  void PlayTo(std::size_t row) {
    for (; next_ < row; ++next_) {
      last_ = filter_.Update(ticks_[next_].frame);
    }
  }
  CoilUpdateReport Play(const sensing::CoilFrame& frame) {
    ++next_;
    return last_ = filter_.Update(frame);
  }
  [[nodiscard]] sensing::CoilFrame Next() const { return ticks_[next_].frame; }
  [[nodiscard]] double Error_m() const {
    return (filter_.state().p_emitter_sensor_m() - ticks_[next_ - 1].p_emitter_sensor_m).norm();
  }
  // The next frame at or after the present one of which `is` is true.
  template <typename Is>
  void PlayToWhere(Is is) {
    while (!is(Next())) {
      PlayTo(next_ + 1);
    }
  }
  static bool IsPulse(const sensing::CoilFrame& f) { return f.drive.coil >= 0 && f.drive.settled; }
  static bool IsBackground(const sensing::CoilFrame& f) {
    return f.drive.coil < 0 && f.drive.settled;
  }
  // Takes the coil's field out of what was read, as if its current were zero.
  static void SwitchOff(simulation::CoilTick& tick) {
    const sensing::CoilSource source;
    const Eigen::Vector3d b_M =
        sensing::CoilField(source, tick.frame.drive.coil, tick.frame.drive.current_a,
                           tick.p_emitter_sensor_m)
            .field_tesla;
    tick.frame.mag_tesla -= tick.q_sensor_emitter * b_M;
  }

  std::vector<simulation::CoilTick> ticks_;
  CoilInertialFilter filter_;
  CoilUpdateReport last_;
  std::size_t next_ = 0;
};

TEST_F(CoilBadInputTest, AShortInertialDropoutIsHeldWithTenfoldNoise) {
  PlayTo(700);
  CoilInertialFilter undisturbed = filter_;
  sensing::CoilFrame frame = Next();
  undisturbed.Update(frame);
  frame.accel_m_s2.setConstant(kNan);
  EXPECT_EQ(Play(frame).verdict, CoilFrameVerdict::kHeld);
  EXPECT_GT(filter_.covariance()(3, 3), undisturbed.covariance()(3, 3) + 5e-5);
  PlayTo(760);
  EXPECT_EQ(filter_.phase(), CoilPhase::kTracking);
  EXPECT_LT(Error_m(), 0.02);
}

TEST_F(CoilBadInputTest, AfterALongDropoutTheVelocityMayBeAnything) {
  PlayTo(700);
  next_ += 12;  // 100 ms are missing
  PlayTo(713);
  EXPECT_GT(std::sqrt(filter_.covariance()(3, 3)), 0.5);
}

TEST_F(CoilBadInputTest, TimeGoingBackDropsTheFrame) {
  PlayTo(700);
  const CoilInertialState before = filter_.state();
  sensing::CoilFrame frame = Next();
  frame.measured_at = ticks_[650].frame.measured_at;
  EXPECT_EQ(filter_.Update(frame).verdict, CoilFrameVerdict::kRejectedOutOfOrder);
  EXPECT_EQ(filter_.state().p_earth_m, before.p_earth_m);
}

TEST_F(CoilBadInputTest, SaturationRaisesTheNoise) {
  PlayTo(700);
  CoilInertialFilter undisturbed = filter_;
  sensing::CoilFrame frame = Next();
  undisturbed.Update(frame);
  frame.inertial_saturated = true;
  Play(frame);
  EXPECT_GT(filter_.covariance()(3, 3), undisturbed.covariance()(3, 3) + 5e-4);
}

TEST_F(CoilBadInputTest, AClippedMagnetometerIsNotUsed) {
  PlayTo(700);
  sensing::CoilFrame frame = Next();
  frame.mag_valid = false;
  frame.mag_tesla.setConstant(150e-6);
  EXPECT_EQ(Play(frame).verdict, CoilFrameVerdict::kInertialOnly);
  EXPECT_LT(Error_m(), 0.02);
}

TEST_F(CoilBadInputTest, AStepOfTheBackgroundIsFlaggedForASecond) {
  PlayTo(700);
  PlayToWhere(IsBackground);
  EXPECT_FALSE(last_.disturbed);
  sensing::CoilFrame frame = Next();
  frame.mag_tesla.x() += 6e-6;
  EXPECT_TRUE(Play(frame).disturbed);
  PlayTo(next_ + 60);
  EXPECT_TRUE(last_.disturbed);
  PlayTo(next_ + 70);
  EXPECT_FALSE(last_.disturbed);
}

TEST_F(CoilBadInputTest, ABackgroundThatIsNotTheEarthsIsFlagged) {
  const Eigen::Vector3d background_tesla = ticks_.front().frame.mag_tesla;
  for (std::size_t k = 0; k < 290; ++k) {  // at rest
    ticks_[k].frame.mag_tesla += background_tesla;
  }
  PlayTo(290);
  EXPECT_EQ(filter_.phase(), CoilPhase::kTracking);
  EXPECT_TRUE(last_.disturbed);
}

TEST_F(CoilBadInputTest, APulseWithAnotherCurrentThanStatedIsMasked) {
  PlayTo(700);
  PlayToWhere(IsPulse);
  sensing::CoilFrame frame = Next();
  frame.drive.measured_a = 1.04 * frame.drive.current_a;
  EXPECT_EQ(Play(frame).verdict, CoilFrameVerdict::kUsed);
  frame = Next();
  frame.drive.measured_a = 0.94 * frame.drive.current_a;
  EXPECT_EQ(Play(frame).verdict, CoilFrameVerdict::kInertialOnly);
  frame = Next();
  frame.drive.current_a = kNan;
  EXPECT_EQ(Play(frame).verdict, CoilFrameVerdict::kInertialOnly);
}

TEST_F(CoilBadInputTest, ACoilThatDoesNotSwitchIsMaskedWithAnAlarmAfterThreePulses) {
  constexpr int kDead = 1;
  for (std::size_t k = 700; k < ticks_.size(); ++k) {
    if (ticks_[k].frame.drive.coil == kDead) {
      SwitchOff(ticks_[k]);
    }
  }
  PlayTo(700);
  int silent_pulses = 0;
  int used = 0;
  bool was_pulse = false;
  while (next_ + 1 < ticks_.size() && !last_.coil_alarm) {
    const bool is_dead = Next().drive.coil == kDead && Next().drive.settled;
    PlayTo(next_ + 1);
    used += is_dead && last_.verdict == CoilFrameVerdict::kUsed ? 1 : 0;
    silent_pulses += is_dead && !was_pulse ? 1 : 0;
    was_pulse = is_dead;
  }
  EXPECT_EQ(silent_pulses, 3);
  EXPECT_EQ(used, 0);
  EXPECT_TRUE(last_.coil_alarm);
  EXPECT_EQ(filter_.phase(), CoilPhase::kTracking) << "on the two that are left";
  EXPECT_LT(Error_m(), 0.05);
}

TEST_F(CoilBadInputTest, ASourceThatIsOffIsALossOfTrack) {
  for (std::size_t k = 700; k < ticks_.size(); ++k) {
    if (ticks_[k].frame.drive.coil >= 0) {
      SwitchOff(ticks_[k]);
    }
  }
  PlayTo(700);
  EXPECT_EQ(filter_.phase(), CoilPhase::kTracking);
  PlayTo(ticks_.size());
  EXPECT_EQ(filter_.phase(), CoilPhase::kAcquiring);
}

TEST_F(CoilBadInputTest, ACovarianceThatIsNotPositiveIsRebuiltAndCounted) {
  PlayTo(700);
  CoilCovariance P = filter_.covariance();
  P(0, 0) = -1e-4;
  filter_.DisturbCovariance(P);
  PlayTo(701);
  EXPECT_TRUE(last_.rebuilt);
  EXPECT_EQ(filter_.rebuilds(), 1);
  PlayTo(900);
  EXPECT_FALSE(last_.rebuilt);
  EXPECT_EQ(filter_.phase(), CoilPhase::kTracking);
  EXPECT_LT(Error_m(), 0.03);
}

TEST_F(CoilBadInputTest, AStateThatIsNotFiniteBeginsAnew) {
  PlayTo(700);
  CoilVector broken = CoilVector::Zero();
  broken[4] = kNan;
  filter_.Disturb(broken);
  PlayTo(701);
  EXPECT_TRUE(last_.lost);
  EXPECT_EQ(filter_.phase(), CoilPhase::kLevelling);
  EXPECT_TRUE(filter_.state().IsFinite());
}

TEST_F(CoilBadInputTest, AllocatesNothingAfterConstruction) {
  CoilFixedLag lag(0.6, 120.0);
  CoilEstimate lagged;
  const std::size_t before = test_support::AllocationCount();
  for (std::size_t k = 0; k < ticks_.size(); ++k) {
    if (k == 900) {
      CoilVector kick = CoilVector::Zero();
      kick[0] = 2.0;
      filter_.Disturb(kick);  // a loss and a new track as well
    }
    last_ = filter_.Update(ticks_[k].frame);
    lag.Update(filter_, ticks_[k].frame.measured_at, lagged);
  }
  EXPECT_EQ(test_support::AllocationCount(), before);
  EXPECT_EQ(filter_.losses(), 1);
  EXPECT_EQ(filter_.phase(), CoilPhase::kTracking);
}

}  // namespace
}  // namespace limbcast::filters
