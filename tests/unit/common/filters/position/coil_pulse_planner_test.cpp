#include "common/filters/position/coil_pulse_planner.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <optional>
#include <vector>

#include "common/filters/position/coil_measurement.hpp"
#include "tests/unit/common/filters/position/coil_scene.hpp"

namespace limbcast::filters {
namespace {

using ::testing::HasSubstr;
using namespace std::chrono_literals;

CoilPulsePlanner MakePlanner(const CoilPlannerConfig& config = {}) {
  return *CoilPulsePlanner::Make(config, SwingConfig());
}

CoilInertialFilter Tracking() {
  CoilInertialFilter filter = *CoilInertialFilter::Make(SwingConfig());
  for (const auto& tick : SwingingSensor(true, simulation::ThesisPulses(), 6.0, 3)) {
    filter.Update(tick.frame);
  }
  EXPECT_EQ(filter.phase(), CoilPhase::kTracking);
  return filter;
}

CoilCovariance Certain() {
  return 1e-8 * CoilCovariance::Identity();  // 0.2 mm, 0.01°
}

// Pulses of `planner` in `span`, asked 100 times a second.
std::vector<CoilPulsePlanner::Pulse> Ask(CoilPulsePlanner& planner,
                                         const CoilInertialFilter& filter, Duration span) {
  std::vector<CoilPulsePlanner::Pulse> pulses;
  for (Duration at{}; at < span; at += 10ms) {
    if (const auto pulse = planner.Next(TimeFromNanoseconds(0) + at, filter)) {
      pulses.push_back(*pulse);
    }
  }
  return pulses;
}

TEST(CoilPulsePlannerTest, WhoIsCertainPulsesAsSeldomAsAllowed) {
  CoilInertialFilter filter = Tracking();
  filter.DisturbCovariance(Certain());
  CoilPulsePlanner planner = MakePlanner({.longest_pause_s = 2.0});
  EXPECT_EQ(Ask(planner, filter, 9990ms).size(), 5U);  // at 0, 2, 4, 6 and 8 s
}

TEST(CoilPulsePlannerTest, WhoIsUncertainPulsesAsMuchAsTheDutyAllows) {
  CoilInertialFilter filter = Tracking();
  CoilCovariance P = Certain();
  P.topLeftCorner<3, 3>() *= 1e6;  // 17 cm
  filter.DisturbCovariance(P);
  CoilPulsePlanner planner = MakePlanner({.pulse_s = 0.06, .max_duty = 0.2});
  const auto pulses = Ask(planner, filter, 30s);
  // 30 s × 0.2 and the three that were saved up, in pulses of 60 ms.
  EXPECT_NEAR(static_cast<double>(pulses.size()), 30.0 * 0.2 / 0.06 + 3.0, 1.5);
  EXPECT_NEAR(planner.Duty(TimeFromNanoseconds(0) + 30s), 0.2, 0.01);
}

TEST(CoilPulsePlannerTest, BetweenTwoPulsesTheBackgroundIsSeen) {
  CoilInertialFilter filter = Tracking();
  filter.DisturbCovariance(CoilCovariance::Identity());
  CoilPulsePlanner planner = MakePlanner({.pulse_s = 0.06, .gap_s = 0.05, .max_duty = 0.9});
  std::optional<Duration> last;
  for (Duration at{}; at < 2s; at += 10ms) {
    if (planner.Next(TimeFromNanoseconds(0) + at, filter)) {
      EXPECT_TRUE(!last || at - *last >= 110ms);
      last = at;
    }
  }
  EXPECT_TRUE(last.has_value());
}

// The coil's pulse must really be the one after which the weighted uncertainty is the smallest:
// measured with the filter itself, by giving it each of the three.
TEST(CoilPulsePlannerTest, TheCoilIsTheOneThatHelpsMost) {
  const CoilPlannerConfig config{.sigma_p_m = 1e-4};
  for (const std::uint64_t seed : {1U, 2U, 3U}) {
    CoilInertialFilter filter = *CoilInertialFilter::Make(SwingConfig());
    const auto ticks = SwingingSensor(true, simulation::ThesisPulses(), 6.0, seed);
    for (const auto& tick : ticks) {
      filter.Update(tick.frame);
    }
    ASSERT_EQ(filter.phase(), CoilPhase::kTracking);
    CoilPulsePlanner planner = MakePlanner(config);
    const auto chosen = planner.Next(ticks.back().frame.measured_at, filter);
    ASSERT_TRUE(chosen.has_value());
    std::array<double, 3> left{};
    for (int coil = 0; coil < 3; ++coil) {
      CoilInertialFilter tried = filter;
      sensing::CoilFrame frame = ticks.back().frame;
      frame.mag_valid = true;
      frame.drive = {.coil = coil, .current_a = 1.5, .settled = true};
      for (int k = 0; k < config.samples; ++k) {
        frame.measured_at += DurationFromSeconds(1.0 / 120.0);
        frame.mag_tesla =
            PredictCoilSample(SwingConfig().source, frame.drive, tried.state()).field_tesla;
        tried.Update(frame);
      }
      const CoilCovariance& P = tried.covariance();
      left[static_cast<std::size_t>(coil)] = P.topLeftCorner<3, 3>().trace();
    }
    const double least = *std::min_element(left.begin(), left.end());
    EXPECT_LT(left[static_cast<std::size_t>(chosen->coil)], 1.05 * least) << "seed " << seed;
  }
}

TEST(CoilPulsePlannerTest, WithoutATrackTheCoilsTakeTurns) {
  CoilInertialFilter filter = *CoilInertialFilter::Make(SwingConfig());
  CoilPulsePlanner planner = MakePlanner();
  EXPECT_TRUE(Ask(planner, filter, 1s).empty()) << "levelling: no pulse helps";
  for (const auto& tick : SwingingSensor(true, {.begin_s = 100.0}, 2.0, 4)) {
    filter.Update(tick.frame);
  }
  ASSERT_EQ(filter.phase(), CoilPhase::kAcquiring);
  CoilPulsePlanner fresh = MakePlanner();
  const auto pulses = Ask(fresh, filter, 2s);
  ASSERT_GT(pulses.size(), 6U);
  for (std::size_t i = 0; i < pulses.size(); ++i) {
    EXPECT_EQ(pulses[i].coil, static_cast<int>(i % 3));
  }
}

TEST(CoilPulsePlannerTest, InSomebodyElsesSlotNothingPulses) {
  const CoilInertialFilter filter = Tracking();
  CoilPulsePlanner planner = MakePlanner();
  EXPECT_FALSE(planner.Next(TimeFromNanoseconds(0), filter, false).has_value());
  EXPECT_TRUE(planner.Next(TimeFromNanoseconds(0) + 10ms, filter, true).has_value());
}

TEST(CoilPulsePlannerTest, NearTheSourceTheCurrentLeavesRoomInTheMagnetometer) {
  const CoilInertialFilter filter = Tracking();
  CoilPulsePlanner full = MakePlanner({.mag_range_tesla = 1e-3});
  const auto strong = full.Next(TimeFromNanoseconds(0), filter);
  ASSERT_TRUE(strong.has_value());
  EXPECT_EQ(strong->current_a, 1.5);
  const double background_tesla = filter.state().background_earth_tesla.norm();
  CoilPulsePlanner narrow = MakePlanner({.mag_range_tesla = (background_tesla + 1e-6) / 0.8});
  const auto weak = narrow.Next(TimeFromNanoseconds(0), filter);
  ASSERT_TRUE(weak.has_value());
  const auto predicted = PredictCoilSample(
      SwingConfig().source, {.coil = weak->coil, .current_a = weak->current_a}, filter.state());
  EXPECT_LT(weak->current_a, 1.5);
  EXPECT_LT(predicted.coil_tesla, 1.001e-6);
}

TEST(CoilPulsePlannerTest, ALimitOutOfRangeIsNamedWithItsValue) {
  const auto made = CoilPulsePlanner::Make({.max_duty = 1.5}, SwingConfig());
  ASSERT_FALSE(made.ok());
  EXPECT_THAT(made.error().message, HasSubstr("max_duty must be in [0.01"));
  EXPECT_THAT(made.error().message, HasSubstr("is 1.5"));
}

}  // namespace
}  // namespace limbcast::filters
