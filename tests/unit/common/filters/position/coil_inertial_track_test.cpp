// The beginning and the end of a track: coil_inertial_track.cpp.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "common/filters/position/coil_inertial_filter.hpp"
#include "tests/unit/common/filters/position/coil_scene.hpp"

namespace limbcast::filters {
namespace {

using Ticks = std::vector<simulation::CoilTick>;

double Error_m(const CoilInertialFilter& filter, const simulation::CoilTick& tick) {
  return (filter.state().p_emitter_sensor_m() - tick.p_emitter_sensor_m).norm();
}

TEST(CoilInertialTrackTest, EveryInjectedLossIsRecoveredWithinTwoSeconds) {
  constexpr std::size_t kEvery = 360;
  int injected = 0;
  int late = 0;
  for (const std::uint64_t seed : {4U, 5U, 6U, 7U}) {
    const Ticks ticks = SwingingSensor(true, simulation::ThesisPulses(), 30.0, seed);
    auto filter = CoilInertialFilter::Make(SwingConfig());
    ASSERT_TRUE(filter);
    for (std::size_t k = 0; k < ticks.size(); ++k) {
      filter->Update(ticks[k].frame);
      if (k >= 600 && k % kEvery == 0 && k + kEvery < ticks.size()) {
        CoilVector kick = CoilVector::Zero();
        kick[CoilInertialIndex::kP + injected % 3] = injected % 2 == 0 ? 0.4 : -0.7;
        kick[CoilInertialIndex::kV + (injected + 1) % 3] = injected % 2 == 0 ? 1.0 : 0.0;
        filter->Disturb(kick);
        ++injected;
      } else if (k >= 600 + kEvery && k % kEvery == 240) {
        late +=
            filter->phase() == CoilPhase::kTracking && Error_m(*filter, ticks[k]) < 0.05 ? 0 : 1;
      }
    }
  }
  EXPECT_GE(injected, 28);
  EXPECT_EQ(late, 0);
}

TEST(CoilInertialTrackTest, NothingIsValidBetweenALossAndTheNextTrack) {
  const Ticks ticks = SwingingSensor(true, simulation::ThesisPulses(), 12.0, 8);
  auto filter = CoilInertialFilter::Make(SwingConfig());
  ASSERT_TRUE(filter);
  bool lost = false;
  for (std::size_t k = 0; k < ticks.size(); ++k) {
    if (k == 720) {
      CoilVector kick = CoilVector::Zero();
      kick[CoilInertialIndex::kP] = 2.0;
      filter->Disturb(kick);
    }
    const CoilUpdateReport report = filter->Update(ticks[k].frame);
    lost = (lost || report.lost) && !report.acquired;
    if (lost) {
      EXPECT_NE(filter->phase(), CoilPhase::kTracking);
      EXPECT_TRUE(filter->records().empty());
    }
  }
  EXPECT_EQ(filter->losses(), 1);
}

TEST(CoilInertialTrackTest, TheSideIsKeptThroughLosses) {
  const Ticks ticks = SwingingSensor(true, simulation::ThesisPulses(), 20.0, 9);
  auto filter = CoilInertialFilter::Make(SwingConfig());
  ASSERT_TRUE(filter);
  for (std::size_t k = 0; k < ticks.size(); ++k) {
    if (k % 500 == 499) {
      CoilVector mirror = CoilVector::Zero();
      mirror.head<3>() = -1.8 * filter->state().p_earth_m;
      filter->Disturb(mirror);
    }
    const CoilUpdateReport report = filter->Update(ticks[k].frame);
    if (report.acquired) {
      EXPECT_GT(filter->state().p_emitter_sensor_m().z(), 0.0);
    }
  }
}

// Without pulses; the last index of it.
void SilencePulses(Ticks& ticks, std::size_t first, std::size_t last) {
  for (std::size_t k = first; k < last; ++k) {
    ticks[k].frame.drive = {.settled = false};
  }
}

TEST(CoilInertialTrackTest, LostForLongTheSideIsTheOneThatPulsesLastAgreedOn) {
  Ticks ticks = SwingingSensor(true, simulation::ThesisPulses(), 30.0, 14);
  constexpr std::size_t kLost = 1200;
  constexpr std::size_t kAgain = 2400;
  SilencePulses(ticks, kLost, kAgain);
  auto filter = CoilInertialFilter::Make(SwingConfig());
  ASSERT_TRUE(filter);
  bool acquired = false;
  for (std::size_t k = 0; k < ticks.size(); ++k) {
    if (k == kLost - 1) {
      filter->ForgetHalfSpace();
    }
    if (k == kLost + 10) {
      filter->LoseTrack();
    }
    if (k == kAgain - 10) {
      // Where dead reckoning has led in ten seconds.
      CoilVector drifted = CoilVector::Zero();
      drifted.head<3>() = -5.0 * ticks[k].p_emitter_sensor_m;
      filter->Disturb(drifted);
    }
    const CoilUpdateReport report = filter->Update(ticks[k].frame);
    if (k > kLost && report.acquired) {
      acquired = true;
      EXPECT_GT(filter->state().p_emitter_sensor_m().z(), 0.0);
    }
  }
  EXPECT_TRUE(acquired);
  EXPECT_EQ(filter->phase(), CoilPhase::kTracking);
  EXPECT_LT(Error_m(*filter, ticks.back()), 0.03);
}

}  // namespace
}  // namespace limbcast::filters
