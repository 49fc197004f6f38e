#include "common/filters/position/coil_loose_filter.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "common/math/rotation.hpp"
#include "tests/support/allocation_counter.hpp"
#include "tests/unit/common/filters/position/coil_scene.hpp"

namespace limbcast::filters {
namespace {

using simulation::CoilTick;
using Ticks = std::vector<CoilTick>;

constexpr double kScoredFrom_s = 5.0;

struct Outcome {
  double rms_m = 0.0;
  double rms_rad = 0.0;
  double nees = 0.0;  // of the position, mean of 3
  int tracked = 0;
};

template <typename Filter>
double Error_m(const Filter& filter, const CoilTick& tick) {
  return (filter.state().p_emitter_sensor_m() - tick.p_emitter_sensor_m).norm();
}

template <typename Filter>
Outcome Play(Filter& filter, const Ticks& ticks) {
  Outcome outcome;
  for (const CoilTick& tick : ticks) {
    filter.Update(tick.frame);
    if (filter.phase() != CoilPhase::kTracking ||
        ToSeconds(tick.frame.measured_at.time_since_epoch()) < kScoredFrom_s) {
      continue;
    }
    const double error_m = Error_m(filter, tick);
    const double error_rad =
        math::AngleBetween_rad(filter.state().q_sensor_emitter(), tick.q_sensor_emitter);
    ++outcome.tracked;
    outcome.rms_m += error_m * error_m;
    outcome.rms_rad += error_rad * error_rad;
    outcome.nees += error_m * error_m / filter.covariance().diagonal().head(3).sum();
  }
  outcome.rms_m = std::sqrt(outcome.rms_m / outcome.tracked);
  outcome.rms_rad = std::sqrt(outcome.rms_rad / outcome.tracked);
  outcome.nees *= 3.0 / outcome.tracked;
  return outcome;
}

LooseCoilFilter MakeFilter(const CoilInertialConfig& config = SwingConfig()) {
  auto made = LooseCoilFilter::Make(config);
  EXPECT_TRUE(made);
  return *made;
}

TEST(LooseCoilFilterTest, TracksASensorFromAMovingSourceAndKnowsHowWell) {
  for (const std::uint64_t seed : {1U, 2U, 3U}) {
    LooseCoilFilter filter = MakeFilter();
    const Outcome outcome =
        Play(filter, SwingingSensor(true, simulation::ThesisPulses(), 25.0, seed));
    EXPECT_EQ(outcome.tracked, 120 * 20);
    EXPECT_EQ(filter.losses(), 0);
    EXPECT_LT(outcome.rms_m, 0.015);
    EXPECT_LT(outcome.rms_rad, 0.035);
    EXPECT_LT(outcome.nees, 6.0);
    EXPECT_GT(outcome.nees, 0.5);
  }
}

TEST(LooseCoilFilterTest, TracksASensorFromAFixedSourceWithoutInertialUnit) {
  LooseCoilFilter filter = MakeFilter();
  const Outcome outcome = Play(filter, SwingingSensor(false, simulation::ThesisPulses(), 25.0, 2));
  EXPECT_EQ(outcome.tracked, 120 * 20);
  EXPECT_LT(outcome.rms_m, 0.015);
}

TEST(LooseCoilFilterTest, IsNoBetterThanTightCoupling) {
  for (const std::uint64_t seed : {1U, 2U, 3U}) {
    const Ticks ticks = SwingingSensor(true, simulation::ThesisPulses(), 25.0, seed);
    LooseCoilFilter loose = MakeFilter();
    auto tight = CoilInertialFilter::Make(SwingConfig());
    ASSERT_TRUE(tight);
    EXPECT_GE(Play(loose, ticks).rms_m, Play(*tight, ticks).rms_m) << seed;
  }
}

TEST(LooseCoilFilterTest, APoseCorrectsAtTheMiddleOfItsBurst) {
  // Its NIS says so: a pose of a fifth of a second ago compared with the state of now would be
  // centimetres off in this motion.
  const Ticks ticks = SwingingSensor(true, simulation::ThesisPulses(), 25.0, 4);
  LooseCoilFilter filter = MakeFilter();
  double sum = 0.0;
  int poses = 0;
  for (const CoilTick& tick : ticks) {
    const CoilUpdateReport report = filter.Update(tick.frame);
    if (report.phase == CoilPhase::kTracking && report.nis > 0.0) {
      sum += report.nis;
      ++poses;
    }
  }
  EXPECT_GE(poses, 36) << "one in each cycle of 0.6 s since 3 s";
  EXPECT_LT(sum / poses, 12.0) << "twice the number of its values";
}

TEST(LooseCoilFilterTest, BadInputDoesNotThrowItOff) {
  Ticks ticks = SwingingSensor(true, simulation::ThesisPulses(), 15.0, 6);
  constexpr std::size_t kSpoiledFrom = 600;
  SpoilFrames(ticks, kSpoiledFrom);
  for (std::size_t k = kSpoiledFrom; k < ticks.size(); ++k) {
    sensing::CoilFrame& frame = ticks[k].frame;
    if (k % 109 == 0 && frame.drive.coil >= 0) {
      frame.drive.measured_a = 0.8 * frame.drive.current_a;
      frame.mag_tesla *= 0.5;
    }
  }
  LooseCoilFilter filter = MakeFilter();
  const Outcome outcome = Play(filter, ticks);
  EXPECT_EQ(filter.losses(), 0);
  EXPECT_LT(outcome.rms_m, 0.02);
}

TEST(LooseCoilFilterTest, SaysWhatBecameOfAFrame) {
  const Ticks ticks = SwingingSensor(true, simulation::ThesisPulses(), 6.0, 7);
  LooseCoilFilter filter = MakeFilter();
  std::size_t k = 0;
  for (; k < 600 || ticks[k].frame.drive.coil < 0 || !ticks[k].frame.drive.settled; ++k) {
    filter.Update(ticks[k].frame);
  }
  ASSERT_EQ(filter.phase(), CoilPhase::kTracking);
  EXPECT_EQ(filter.Update(ticks[k].frame).verdict, CoilFrameVerdict::kUsed);
  const Eigen::Vector3d p_earth_m = filter.state().p_earth_m;
  EXPECT_EQ(filter.Update(ticks[k].frame).verdict, CoilFrameVerdict::kRejectedOutOfOrder);
  EXPECT_EQ(filter.Update(ticks[k - 50].frame).verdict, CoilFrameVerdict::kRejectedOutOfOrder);
  EXPECT_EQ(filter.state().p_earth_m, p_earth_m);
  sensing::CoilFrame frame = ticks[k + 1].frame;
  frame.mag_valid = false;
  EXPECT_EQ(filter.Update(frame).verdict, CoilFrameVerdict::kInertialOnly);
  frame = ticks[k + 2].frame;
  frame.gyro_rad_s.x() = std::numeric_limits<double>::infinity();
  EXPECT_EQ(filter.Update(frame).verdict, CoilFrameVerdict::kHeld);
}

TEST(LooseCoilFilterTest, ALossIsFoundAndRecoveredAndNothingIsValidBetween) {
  const Ticks ticks = SwingingSensor(true, simulation::ThesisPulses(), 20.0, 8);
  LooseCoilFilter filter = MakeFilter();
  bool lost = false;
  for (std::size_t k = 0; k < ticks.size(); ++k) {
    if (k == 720) {
      CoilVector kick = CoilVector::Zero();
      kick[CoilInertialIndex::kP] = 1.0;
      filter.Disturb(kick);
    }
    const CoilUpdateReport report = filter.Update(ticks[k].frame);
    lost = (lost || report.lost) && !report.acquired;
    EXPECT_EQ(report.phase, filter.phase());
    EXPECT_FALSE(lost && filter.phase() == CoilPhase::kTracking);
    if (k >= 720 + 4 * 120) {  // three cycles until it is found, and one for a new track
      ASSERT_EQ(filter.phase(), CoilPhase::kTracking);
      EXPECT_LT(Error_m(filter, ticks[k]), 0.06);
    }
  }
  EXPECT_EQ(filter.losses(), 1);
}

TEST(LooseCoilFilterTest, ASourceThatIsOffIsALossOfTrack) {
  Ticks ticks = SwingingSensor(true, simulation::ThesisPulses(), 12.0, 9);
  for (std::size_t k = 720; k < ticks.size(); ++k) {
    CoilTick& tick = ticks[k];
    if (tick.frame.drive.coil >= 0) {
      tick.frame.mag_tesla -= tick.q_sensor_emitter * sensing::CoilField({}, tick.frame.drive.coil,
                                                                         tick.frame.drive.current_a,
                                                                         tick.p_emitter_sensor_m)
                                                          .field_tesla;
    }
  }
  LooseCoilFilter filter = MakeFilter();
  for (const CoilTick& tick : ticks) {
    filter.Update(tick.frame);
  }
  EXPECT_EQ(filter.losses(), 1);
  EXPECT_EQ(filter.phase(), CoilPhase::kAcquiring);
}

TEST(LooseCoilFilterTest, MoreFramesWithoutAPoseThanItKeepsMoveTheAnchorOn) {
  Ticks ticks = SwingingSensor(true, simulation::ThesisPulses(), 14.0, 10);
  for (std::size_t k = 720; k < 720 + 300; ++k) {
    ticks[k].frame.mag_valid = false;
  }
  CoilInertialConfig config = SwingConfig();
  config.lost_relative_sigma = 10.0;  // keeps the track through it
  LooseCoilFilter filter = MakeFilter(config);
  for (const CoilTick& tick : ticks) {
    filter.Update(tick.frame);
  }
  EXPECT_EQ(filter.losses(), 0);
  EXPECT_LT(Error_m(filter, ticks.back()), 0.03);
}

TEST(LooseCoilFilterTest, AnEstimateThatIsNotFiniteBeginsAnew) {
  const Ticks ticks = SwingingSensor(true, simulation::ThesisPulses(), 12.0, 11);
  LooseCoilFilter filter = MakeFilter();
  for (std::size_t k = 0; k < 481; ++k) {
    if (k == 480) {
      ASSERT_EQ(filter.phase(), CoilPhase::kTracking);
      CoilVector broken = CoilVector::Zero();
      broken[0] = std::numeric_limits<double>::quiet_NaN();
      filter.Disturb(broken);
    }
    EXPECT_EQ(filter.Update(ticks[k].frame).lost, k == 480) << k;
  }
  EXPECT_EQ(filter.phase(), CoilPhase::kLevelling);
  EXPECT_EQ(filter.losses(), 1);
  bool tracked_again = false;
  for (std::size_t k = 481; k < ticks.size(); ++k) {
    tracked_again = filter.Update(ticks[k].frame).acquired || tracked_again;
    EXPECT_TRUE(filter.state().IsFinite());
  }
  EXPECT_TRUE(tracked_again);
}

TEST(LooseCoilFilterTest, AllocatesNothingAfterConstruction) {
  const Ticks ticks = SwingingSensor(true, simulation::ThesisPulses(), 14.0, 12);
  LooseCoilFilter filter = MakeFilter();
  const std::size_t before = test_support::AllocationCount();
  for (std::size_t k = 0; k < ticks.size(); ++k) {
    if (k == 720) {
      CoilVector kick = CoilVector::Zero();
      kick[0] = 2.0;
      filter.Disturb(kick);  // a loss and a new track as well
    }
    filter.Update(ticks[k].frame);
  }
  EXPECT_EQ(test_support::AllocationCount(), before);
  EXPECT_EQ(filter.losses(), 1);
  EXPECT_EQ(filter.phase(), CoilPhase::kTracking);
}

TEST(LooseCoilFilterTest, RefusesAConfigurationThatIsNotValidOrHasNoHalfSpace) {
  CoilInertialConfig config = SwingConfig();
  config.sigma_mag_tesla = 0.0;
  const auto invalid = LooseCoilFilter::Make(config);
  ASSERT_FALSE(invalid);
  EXPECT_NE(invalid.error().message.find("sigma_mag_tesla"), std::string::npos);
  const auto no_side = LooseCoilFilter::Make(CoilInertialConfig());
  ASSERT_FALSE(no_side);
  EXPECT_NE(no_side.error().message.find("half_space"), std::string::npos);
}

}  // namespace
}  // namespace limbcast::filters
