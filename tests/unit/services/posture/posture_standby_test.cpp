// A posture service beside or after another one.
#include <gtest/gtest.h>

#include <limits>
#include <vector>

#include "common/math/rotation.hpp"
#include "tests/unit/services/posture/posture_rig.hpp"

namespace limbcast::posture {
namespace {

using body::Segment;

constexpr BodyId kBody{1};
const std::vector<Segment> kThree = {Segment::kPelvis, Segment::kT8, Segment::kHead};

// The definition that a body has in force after a reference pose, and what it was mounted like.
body::BodyDefinition AlignedDefinition(const Eigen::Quaterniond& mounted) {
  PostureRig rig;
  rig.Roster(MakeRoster(kBody, kThree));
  rig.Run(kBody, kThree, 0.5, mounted);
  EXPECT_TRUE(rig.Command(kBody, roster::CommandKind::kReferencePose).accepted);
  EXPECT_TRUE(rig.Command(kBody, roster::CommandKind::kSetDimensions, "height", {1.9}).accepted);
  return rig.definitions.back();
}

TEST(PostureStandbyTest, AServiceThatStandsByTakesOverWhatAnotherOneHasInForce) {
  const Eigen::Quaterniond mounted = math::ExpSO3({0.3, 0.1, -0.4});
  const body::BodyDefinition in_force = AlignedDefinition(mounted);
  for (const bool roster_first : {true, false}) {
    SCOPED_TRACE(roster_first ? "roster first" : "definition first");
    PostureRig rig;
    if (roster_first) {
      rig.Roster(MakeRoster(kBody, kThree));
      ASSERT_FALSE(rig.definitions.back().segments[0].aligned);
    }
    ASSERT_TRUE(rig.other_definitions->Write(in_force).ok());
    if (!roster_first) {
      rig.Roster(MakeRoster(kBody, kThree));
    }
    rig.Run(kBody, kThree, 0.1, mounted);
    EXPECT_TRUE(rig.definitions.back().segments[0].aligned);
    EXPECT_EQ(rig.Counted(Count::kAdopted), 1U);
    EXPECT_LT(math::AngleBetween_rad(rig.Last(Segment::kHead).q_earth_segment.cast<double>(),
                                     Eigen::Quaterniond::Identity()),
              1e-6);
    EXPECT_NEAR(rig.Last(Segment::kPelvis).p_earth_segment_m.z(), 0.530 * 1.9, 1e-6);
  }
}

TEST(PostureStandbyTest, WhatAnotherServiceSaysOfOtherSensorsOrNonsenseIsNotTakenOver) {
  const body::BodyDefinition in_force = AlignedDefinition(math::ExpSO3({0.3, 0.1, -0.4}));
  PostureRig rig;
  rig.Roster(MakeRoster(kBody, kThree));

  body::BodyDefinition others_sensors = in_force;
  for (body::SegmentDefinition& segment : others_sensors.segments) {
    segment.sensor_uid.value += segment.sensor_uid.value == 0 ? 0 : 1;
  }
  ASSERT_TRUE(rig.other_definitions->Write(others_sensors).ok());
  body::BodyDefinition nonsense = in_force;
  for (body::SegmentDefinition& segment : nonsense.segments) {
    segment.q_sensor_segment.coeffs().setConstant(std::numeric_limits<double>::quiet_NaN());
  }
  ASSERT_TRUE(rig.other_definitions->Write(nonsense).ok());
  body::BodyDefinition old = in_force;
  old.revision = 0;
  ASSERT_TRUE(rig.other_definitions->Write(old).ok());
  rig.Run(kBody, kThree, 0.1);
  EXPECT_EQ(rig.Counted(Count::kAdopted), 0U);
  EXPECT_FALSE(rig.definitions.back().segments[0].aligned);

  ASSERT_TRUE(rig.other_definitions->Write(in_force).ok());
  EXPECT_TRUE(rig.Command(kBody, roster::CommandKind::kSetDimensions, "height", {1.8}).accepted);
  EXPECT_EQ(rig.Counted(Count::kAdopted), 1U) << "the one that fits";
}

}  // namespace
}  // namespace limbcast::posture
