// The magnetic + inertial filter with sources that the thesis did not have: three tones at once
// (sensing/coil_tones.hpp), and coils apart.
#include <gtest/gtest.h>

#include <cmath>

#include "common/filters/position/coil_inertial_filter.hpp"
#include "tests/support/allocation_counter.hpp"
#include "tests/unit/common/filters/position/coil_scene.hpp"

namespace limbcast::filters {
namespace {

using Ticks = std::vector<simulation::CoilTick>;

Ticks SwingingInTones(double duration_s, std::uint64_t seed) {
  simulation::CoilStreamConfig stream = SwingStream(true, simulation::ThesisPulses());
  stream.tones = sensing::CoilTones{};
  return simulation::SimulateCoil(stream, duration_s, seed);
}

double Error_m(const CoilInertialFilter& filter, const simulation::CoilTick& tick) {
  return (filter.state().p_emitter_sensor_m() - tick.p_emitter_sensor_m).norm();
}

double RmsFrom_m(CoilInertialFilter& filter, const Ticks& ticks, std::size_t first) {
  double sum = 0.0;
  for (std::size_t k = 0; k < ticks.size(); ++k) {
    filter.Update(ticks[k].frame);
    if (k >= first) {
      EXPECT_EQ(filter.phase(), CoilPhase::kTracking) << k;
      sum += std::pow(Error_m(filter, ticks[k]), 2);
    }
  }
  return std::sqrt(sum / static_cast<double>(ticks.size() - first));
}

TEST(CoilTonesTest, TrackASensorBetterThanPulsesOfTheSameHeat) {
  for (const std::uint64_t seed : {1U, 2U, 3U}) {
    auto of_tones = CoilInertialFilter::Make(SwingConfig());
    auto of_pulses = CoilInertialFilter::Make(SwingConfig());
    ASSERT_TRUE(of_tones && of_pulses);
    const double tones_m = RmsFrom_m(*of_tones, SwingingInTones(20.0, seed), 600);
    const double pulses_m =
        RmsFrom_m(*of_pulses, SwingingSensor(true, simulation::ThesisPulses(), 20.0, seed), 600);
    EXPECT_LT(tones_m, pulses_m) << seed;
    EXPECT_EQ(of_tones->losses(), 0);
  }
}

TEST(CoilTonesTest, ALossIsRecoveredWithinTwoSeconds) {
  const Ticks ticks = SwingingInTones(30.0, 4);
  auto filter = CoilInertialFilter::Make(SwingConfig());
  ASSERT_TRUE(filter);
  int injected = 0;
  for (std::size_t k = 0; k < ticks.size(); ++k) {
    filter->Update(ticks[k].frame);
    if (k >= 600 && k % 360 == 0) {
      CoilVector kick = CoilVector::Zero();
      kick[CoilInertialIndex::kP + injected % 3] = injected % 2 == 0 ? 0.4 : -0.7;
      filter->Disturb(kick);
      ++injected;
    } else if (k >= 960 && k % 360 == 240) {
      EXPECT_EQ(filter->phase(), CoilPhase::kTracking) << k;
      EXPECT_LT(Error_m(*filter, ticks[k]), 0.05) << k;
    }
  }
  EXPECT_GE(injected, 8);
}

TEST(CoilTonesTest, ASourceThatIsSwitchedOffIsNoticed) {
  Ticks ticks = SwingingInTones(12.0, 5);
  auto filter = CoilInertialFilter::Make(SwingConfig());
  ASSERT_TRUE(filter);
  constexpr std::size_t kOff = 720;
  std::size_t lost_at = 0;
  for (std::size_t k = 0; k < ticks.size(); ++k) {
    sensing::CoilFrame& frame = ticks[k].frame;
    if (k >= kOff) {
      frame.mag_tesla -=
          ticks[k].q_sensor_emitter *
          sensing::CoilsField({}, frame.drive.tones_a, ticks[k].p_emitter_sensor_m).field_tesla;
    }
    const CoilUpdateReport report = filter->Update(frame);
    if (report.lost && lost_at == 0) {
      lost_at = k;
    }
  }
  EXPECT_GE(lost_at, kOff);
  EXPECT_LT(lost_at, kOff + 120) << "a second";
  EXPECT_NE(filter->phase(), CoilPhase::kTracking);
}

TEST(CoilTonesTest, BadReadingsAreSurvivedAndNothingAllocates) {
  Ticks ticks = SwingingInTones(12.0, 6);
  SpoilFrames(ticks, 400);
  auto filter = CoilInertialFilter::Make(SwingConfig());
  ASSERT_TRUE(filter);
  const std::size_t before = test_support::AllocationCount();
  double worst_m = 0.0;
  for (std::size_t k = 0; k < ticks.size(); ++k) {
    filter->Update(ticks[k].frame);
    worst_m = k >= 600 ? std::max(worst_m, Error_m(*filter, ticks[k])) : worst_m;
  }
  EXPECT_EQ(test_support::AllocationCount(), before);
  EXPECT_EQ(filter->phase(), CoilPhase::kTracking);
  EXPECT_LT(worst_m, 0.05);
}

TEST(CoilsApartTest, AreTrackedWithoutBeingToldTheSide) {
  simulation::CoilStreamConfig stream = SwingStream(true, simulation::ThesisPulses());
  stream.source.centre_m.col(0) = Eigen::Vector3d(0.0, 0.1, 0.0);
  stream.source.centre_m.col(1) = Eigen::Vector3d(0.0, -0.1, 0.0);
  const Ticks ticks = simulation::SimulateCoil(stream, 20.0, 7);
  CoilInertialConfig config = SwingConfig();
  config.half_space.reset();
  config.source = stream.source;
  auto filter = CoilInertialFilter::Make(config);
  ASSERT_TRUE(filter);
  EXPECT_LT(RmsFrom_m(*filter, ticks, 600), 0.02);
  EXPECT_EQ(filter->losses(), 0);
}

}  // namespace
}  // namespace limbcast::filters
