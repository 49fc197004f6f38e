#include "common/body/joint_heading.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "tests/support/walking_person.hpp"

namespace limbcast::body {
namespace {

using test_support::WalkingPerson;

class JointHeadingTest : public ::testing::TestWithParam<std::pair<Segment, Segment>> {};

TEST_P(JointHeadingTest, TheTurnBetweenTheSensorsIsFoundOnTheWholeCircle) {
  const auto [parent, child] = GetParam();
  for (const std::uint64_t seed : {1U, 2U, 3U, 4U, 5U}) {
    const WalkingPerson person(seed);
    const auto motions = Smooth(person.Record({parent, child}, 8.0, 20.0), 0.12);
    const auto joint = FitJointHeading(motions[0], motions[1], 50.0);
    ASSERT_TRUE(joint.has_value());
    const double expected_rad =
        person.sensor_heading_rad(parent) - person.sensor_heading_rad(child);
    const double error_rad = std::remainder(joint->turn_rad - expected_rad, 2.0 * std::numbers::pi);
    // A perfect joint; what is left is the smoothing, which bends fast swings.
    EXPECT_LT(std::abs(error_rad), 0.06) << "seed " << seed;
    EXPECT_LT(joint->misfit, 0.35);
  }
}
INSTANTIATE_TEST_SUITE_P(Joints, JointHeadingTest,
                         ::testing::Values(std::pair{Segment::kRightUpperLeg,
                                                     Segment::kRightLowerLeg},
                                           std::pair{Segment::kLeftLowerLeg, Segment::kLeftFoot},
                                           std::pair{Segment::kLeftUpperArm, Segment::kLeftForeArm},
                                           std::pair{Segment::kRightForeArm, Segment::kRightHand}));

TEST(JointHeadingEdgeTest, WithoutMotionTheTurnIsUnknownAndSaysSo) {
  const WalkingPerson person;
  const auto motions =
      Smooth(person.Record({Segment::kRightUpperLeg, Segment::kRightLowerLeg}, 0.2, 2.8), 0.12);
  const auto joint = FitJointHeading(motions[0], motions[1], 50.0);
  ASSERT_TRUE(joint.has_value());
  EXPECT_TRUE(joint->sigma_rad > 1.0 || joint->misfit > 0.9);
}

TEST(JointHeadingEdgeTest, TooShortOrUnevenRecordsGiveNothing) {
  const WalkingPerson person;
  auto motions =
      Smooth(person.Record({Segment::kRightUpperLeg, Segment::kRightLowerLeg}, 8.0, 9.0), 0.12);
  EXPECT_FALSE(FitJointHeading(motions[0], motions[1], 50.0));
  motions[1].q_earth_sensor.pop_back();
  EXPECT_FALSE(FitJointHeading(motions[0], motions[1], 50.0));
}

}  // namespace
}  // namespace limbcast::body
