#include "common/body/gait.hpp"

#include <gtest/gtest.h>

#include "tests/support/walking_person.hpp"

namespace limbcast::body {
namespace {

using test_support::WalkingPerson;

TEST(GaitTest, TheStrideOfASimulatedWalkerIsFoundFromTheLegs) {
  const WalkingPerson person;
  const auto motions = Smooth(person.Record(WalkingPerson::Sixteen(), 6.0, 26.0), 0.12);
  const auto gait = FindGait(motions, 50.0);
  ASSERT_TRUE(gait.has_value());
  // 1.85 steps a second at 1.1 m/s (motion_schedule.cpp), to the sample.
  EXPECT_NEAR(gait->stride_s, 2.0 / 1.85, 0.03);
  EXPECT_GT(gait->periodicity, 0.8);
}

TEST(GaitTest, WithoutSensorsOnTheLegsTheTrunkGivesTheSameStride) {
  const WalkingPerson person;
  const auto motions =
      Smooth(person.Record({Segment::kPelvis, Segment::kT8, Segment::kHead}, 6.0, 26.0), 0.12);
  const auto gait = FindGait(motions, 50.0);
  ASSERT_TRUE(gait.has_value());
  EXPECT_NEAR(gait->stride_s, 2.0 / 1.85, 0.05);
}

TEST(GaitTest, StandingIsNoWalking) {
  const WalkingPerson person;
  EXPECT_FALSE(FindGait(Smooth(person.Record(WalkingPerson::Sixteen(), 45.0, 60.0), 0.12), 50.0));
}

TEST(GaitTest, TheWalkIsFoundBetweenStandingBeforeAndAfter) {
  const WalkingPerson person;  // stands 3 s, walks 35 m at 1.1 m/s, stands
  const auto motions = Smooth(person.Record(WalkingPerson::Sixteen(), 0.0, 50.0), 0.12);
  EXPECT_FALSE(FindGait(motions, 50.0)) << "not all of it is walking";
  const Stretch walk = LongestActivity(motions, 50.0);
  EXPECT_NEAR(static_cast<double>(walk.begin) / 50.0, 3.0, 1.5);
  EXPECT_NEAR(static_cast<double>(walk.end) / 50.0, 3.0 + 35.0 / 1.1, 2.5);
}

}  // namespace
}  // namespace limbcast::body
