#include "common/body/joint_angle_frame.hpp"

#include <gtest/gtest.h>

#include "common/math/rotation.hpp"

namespace limbcast::body {
namespace {

Skeleton Standing() {
  Skeleton skeleton;
  skeleton.body_id = BodyId{7};
  skeleton.sequence = 42;
  skeleton.measured_at = TimeFromNanoseconds(123);
  for (const Segment segment : AllSegments()) {
    skeleton.segments.push_back(
        {.segment = segment, .status = SegmentStatus::kTracked, .confidence = 0.9F});
  }
  return skeleton;
}

TEST(JointAngleFrameTest, HasEveryJointOfAWholeSkeletonAndItsTime) {
  JointAngleFrame frame;
  FillJointAngles(Standing(), frame);
  EXPECT_EQ(frame.body_id, BodyId{7});
  EXPECT_EQ(frame.sequence, 42U);
  EXPECT_EQ(frame.measured_at, TimeFromNanoseconds(123));
  ASSERT_EQ(frame.joints.size(), kJointCount);
  for (std::size_t i = 0; i < kJointCount; ++i) {
    EXPECT_EQ(Index(frame.joints[i].joint), i);
    EXPECT_TRUE(frame.joints[i].angle_rad.isZero());
    EXPECT_EQ(frame.joints[i].confidence, 0.9F);
  }
}

TEST(JointAngleFrameTest, AnglesAreThoseOfTheTwoSegmentsAndTheLesserConfidence) {
  Skeleton skeleton = Standing();
  SegmentPose& shin = skeleton.segments[Index(Segment::kRightLowerLeg)];
  shin.q_earth_segment = math::ExpSO3({0.0, 0.5, 0.0}).cast<float>();
  shin.confidence = 0.25F;
  JointAngleFrame frame;
  FillJointAngles(skeleton, frame);
  const auto joint = [&](Joint which) { return frame.joints[Index(which)]; };
  EXPECT_NEAR(joint(Joint::kRightKnee).angle_rad.x(), 0.5, 1e-6);
  EXPECT_NEAR(joint(Joint::kRightAnkle).angle_rad.x(), 0.5, 1e-6);
  EXPECT_EQ(joint(Joint::kRightKnee).confidence, 0.25F);
  EXPECT_EQ(joint(Joint::kLeftKnee).confidence, 0.9F);
}

TEST(JointAngleFrameTest, JointsWithoutBothSegmentsAreLeftOut) {
  Skeleton skeleton = Standing();
  skeleton.segments.resize(Index(Segment::kNeck));  // pelvis to T8
  JointAngleFrame frame;
  FillJointAngles(skeleton, frame);
  ASSERT_EQ(frame.joints.size(), 2U);
  EXPECT_EQ(frame.joints[0].joint, Joint::kPelvis);
  EXPECT_EQ(frame.joints[1].joint, Joint::kTrunk);
}

}  // namespace
}  // namespace limbcast::body
