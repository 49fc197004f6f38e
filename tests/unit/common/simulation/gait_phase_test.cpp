#include "common/simulation/gait_phase.hpp"

#include <gtest/gtest.h>

namespace limbcast::simulation {
namespace {

TEST(GaitPhaseTest, CountsStepsFromTheFirstLiftAndFadesInAndOut) {
  const auto timeline = Timeline::Make(MakeDefaultSchedule());
  const TimedPhase& walk = *timeline->At(10.0).phase;
  ASSERT_EQ(walk.phase.kind, PhaseKind::kWalk);
  EXPECT_NEAR(GaitPhaseAt(walk, Jet{kFirstLift * walk.step_s}).steps.value, 0.0, 1e-12);
  EXPECT_NEAR(GaitPhaseAt(walk, Jet{5.0 * walk.step_s}).steps.value, 5.0 - kFirstLift, 1e-12);
  EXPECT_EQ(GaitPhaseAt(walk, Jet{0.0}).amount.value, 0.0);
  EXPECT_EQ(GaitPhaseAt(walk, Jet{5.0 * walk.step_s}).amount.value, 1.0);
  EXPECT_NEAR(GaitPhaseAt(walk, Jet{walk.duration_s()}).amount.value, 0.0, 1e-12);
}

TEST(GaitPhaseTest, StandingHasNoGait) {
  const auto timeline = Timeline::Make(MakeStandingSchedule());
  EXPECT_EQ(GaitPhaseAt(*timeline->At(1.0).phase, Jet{1.0}).amount.value, 0.0);
}

TEST(GaitPhaseTest, RightAndLeftStepsAlternate) {
  const GaitPhase right{.steps = 4.3, .amount = 1.0};
  const GaitPhase left{.steps = 5.3, .amount = 1.0};
  EXPECT_NEAR(right.Alternating(0.3).value, 1.0, 1e-12);
  EXPECT_NEAR(left.Alternating(0.3).value, -1.0, 1e-12);
  EXPECT_NEAR(right.EveryStep(0.3).value, 1.0, 1e-12);
  EXPECT_NEAR(left.EveryStep(0.3).value, 1.0, 1e-12);
}

}  // namespace
}  // namespace limbcast::simulation
