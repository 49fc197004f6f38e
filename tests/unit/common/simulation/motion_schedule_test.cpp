#include "common/simulation/motion_schedule.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <string>

namespace limbcast::simulation {
namespace {

TEST(MotionScheduleTest, DefaultStandsInNPoseAndRepeatsFromTheWalk) {
  const auto timeline = Timeline::Make(MakeDefaultSchedule(5.0));
  ASSERT_TRUE(timeline.ok()) << timeline.error().message;
  EXPECT_EQ(timeline->At(4.9).phase->phase.kind, PhaseKind::kNPose);
  EXPECT_FALSE(timeline->At(4.9).phase->unlocks);
  EXPECT_TRUE(timeline->At(5.5).phase->unlocks);
  EXPECT_EQ(timeline->At(6.1).phase->phase.kind, PhaseKind::kWalk);
  EXPECT_NEAR(timeline->repeat_from_s(), 6.0, 1e-12);

  const double round_s = timeline->phases().back().end_s - timeline->repeat_from_s();
  const auto first = timeline->At(17.3);
  const auto later = timeline->At(17.3 + 3.0 * round_s);
  EXPECT_EQ(first.phase, later.phase);
  EXPECT_NEAR(first.since_s.value, later.since_s.value, 1e-9);
}

TEST(MotionScheduleTest, PhasesJoinWithoutJumpOfPlaceOrSpeed) {
  const auto timeline = Timeline::Make(MakeDefaultSchedule(), {1.0, -2.0, 0.4});
  ASSERT_TRUE(timeline.ok());
  for (const TimedPhase& phase : timeline->phases()) {
    const MovingFloorPose begin = FloorPoseAt(phase, Jet::Variable(0.0));
    const MovingFloorPose end = FloorPoseAt(phase, Jet::Variable(phase.duration_s()));
    EXPECT_NEAR(begin.x_m.value, phase.from.x_m, 1e-9);
    EXPECT_NEAR(end.x_m.value, phase.to.x_m, 1e-9);
    EXPECT_NEAR(end.y_m.value, phase.to.y_m, 1e-9);
    EXPECT_NEAR(
        std::remainder(end.heading_rad.value - phase.to.heading_rad, 2.0 * std::numbers::pi), 0.0,
        1e-9);
    EXPECT_NEAR(end.x_m.rate, 0.0, 1e-9);
    EXPECT_NEAR(begin.heading_rad.accel, 0.0, 1e-9);
  }
}

TEST(MotionScheduleTest, WalksAtTheWishedSpeedInWholeSteps) {
  const auto timeline = Timeline::Make(MakeDefaultSchedule());
  const TimedPhase& walk = *timeline->At(10.0).phase;
  EXPECT_NEAR(walk.phase.speed_m_s, 1.1, 0.06);
  EXPECT_NEAR(walk.duration_s() / walk.step_s - kFirstLift, walk.steps, 1e-9);
  EXPECT_NEAR(walk.step_length_m, 0.6, 0.05);
  const MovingFloorPose at = FloorPoseAt(walk, Jet::Variable(0.5 * walk.duration_s()));
  EXPECT_NEAR(std::hypot(at.x_m.rate, at.y_m.rate), walk.phase.speed_m_s, 1e-9);
}

struct Refusal {
  Phase phase;
  std::string says;
};

TEST(MotionScheduleTest, RefusalsNameThePhaseAndTheLimit) {
  const std::vector<Refusal> refusals = {
      {{.kind = PhaseKind::kWalk}, "needs a path"},
      {{.kind = PhaseKind::kWalk, .path = {{0.05}}}, "0.1 to 1000 m"},
      {{.kind = PhaseKind::kWalk, .path = {{0.5}}}, "at least 1 m"},
      {{.kind = PhaseKind::kWalk, .path = {{1.0, 3.0}}}, "tighter than 0.6 m"},
      {{.kind = PhaseKind::kWalk, .path = {{3.0}}, .speed_m_s = 5.0}, "speed_m_s"},
      {{.kind = PhaseKind::kWalk, .path = {{3.0}}}, "must end where"},
      {{.kind = PhaseKind::kSit, .duration_s = 2.0}, "duration_s"},
      {{.kind = PhaseKind::kStand, .duration_s = std::nan("")}, "duration_s"},
      {{.kind = PhaseKind::kTurn, .duration_s = 3.0, .turn_rad = 9.0}, "turn_rad"},
      {{.kind = PhaseKind::kStand,
        .duration_s = 2.0,
        .gestures = {{GestureKind::kWave, Side::kLeft, 1.0, 3.0}}},
       "a gesture"},
  };
  for (const Refusal& refusal : refusals) {
    const Status status = Validate({.phases = {refusal.phase}});
    ASSERT_FALSE(status.ok()) << refusal.says;
    EXPECT_NE(status.error().message.find(refusal.says), std::string::npos)
        << status.error().message;
  }
  EXPECT_FALSE(Validate(MotionSchedule{}).ok());
  EXPECT_TRUE(Validate(MakeStandingSchedule()).ok());
}

}  // namespace
}  // namespace limbcast::simulation
