#include "common/simulation/upper_body.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace limbcast::simulation {
namespace {

constexpr double kDeg = std::numbers::pi / 180.0;

TEST(UpperBodyTest, NPoseHasNoAngles) {
  const auto timeline = Timeline::Make(MakeStandingSchedule());
  const auto place = timeline->At(3.0);
  const UpperBodyAngles body =
      UpperBodyAt(*place.phase, place.since_s, {}, Jet{0.0}, Jet::Variable(3.0));
  EXPECT_EQ(body.trunk_flex_rad.value, 0.0);
  EXPECT_EQ(body.head_yaw_rad.value, 0.0);
  for (const ArmAngles& arm : body.arms) {
    EXPECT_EQ(arm.elbow_rad.value, 0.0);
    EXPECT_EQ(arm.abduction_rad.value, 0.0);
    EXPECT_EQ(arm.axial_rad.rate, 0.0);
  }
}

TEST(UpperBodyTest, GesturesReachTheirAnglesAndLeaveNothing) {
  const MotionSchedule schedule = {
      .phases = {{.kind = PhaseKind::kStand,
                  .duration_s = 8.0,
                  .gestures = {{GestureKind::kRaiseFront, Side::kRight, 1.0, 4.0}}}}};
  const auto timeline = Timeline::Make(schedule);
  ASSERT_TRUE(timeline.ok());
  const auto right_flexion_rad = [&](double t_s) {
    const auto place = timeline->At(t_s);
    return UpperBodyAt(*place.phase, place.since_s, {}, Jet{1.0}, Jet::Variable(0.0))
        .arms[0]
        .flexion_rad.value;
  };
  const double at_rest_rad = right_flexion_rad(0.9);
  EXPECT_NEAR(right_flexion_rad(3.0) - at_rest_rad, 150.0 * kDeg, 1e-9);
  EXPECT_NEAR(right_flexion_rad(5.1), at_rest_rad, 1e-9);
}

TEST(UpperBodyTest, ArmsSwingAgainstTheLegs) {
  const auto timeline = Timeline::Make(MakeDefaultSchedule());
  const TimedPhase& walk = *timeline->At(10.0).phase;
  const Jet landing_s = (kFirstLift + 6.0 + 0.85) * walk.step_s;  // a right foot
  const GaitPhase gait = GaitPhaseAt(walk, landing_s);
  TimedPhase quiet = walk;
  quiet.phase.gestures.clear();
  const UpperBodyAngles body = UpperBodyAt(quiet, landing_s, gait, Jet{1.0}, Jet{0.0});
  EXPECT_GT(body.arms[1].flexion_rad.value, 12.0 * kDeg);  // left arm forward
  EXPECT_LT(body.arms[0].flexion_rad.value, -8.0 * kDeg);  // right arm back
  EXPECT_LT(body.trunk_yaw_rad.value, -4.0 * kDeg);        // right shoulder back
}

}  // namespace
}  // namespace limbcast::simulation
