#include "tests/unit/common/bus/wire/codec_properties.hpp"

namespace limbcast::bus::testing {
namespace {

using PostureTopics = ::testing::Types<body::BodyDefinition, body::Skeleton, body::JointAngleFrame>;
INSTANTIATE_TYPED_TEST_SUITE_P(Posture, CodecTest, PostureTopics);

TEST(PostureCodecTest, MoreThan32SegmentsAreRefusedInBothDirections) {
  body::Skeleton skeleton;
  skeleton.segments.resize(33);
  ExpectOutOfBounds(skeleton, "skeleton.segments has 33 elements, at most 32 are allowed");
  wire::BodyDefinition received;
  received.segments().resize(33);
  ExpectCorrupt<body::BodyDefinition>(
      received, "body_definition.segments has 33 elements, at most 32 are allowed");
}

TEST(PostureCodecTest, ABadNumberInsideAListIsRefused) {
  wire::Skeleton received;
  received.segments().resize(2);
  received.segments()[1].status(4);
  ExpectCorrupt<body::Skeleton>(received,
                                "skeleton.status has 4 as its number, at most 3 are allowed");
}

TEST(PostureCodecTest, ALayoutOfJointAnglesIsAsTheIdlSays) {
  body::JointAngleFrame frame;
  frame.joints.resize(body::kJointCount);
  wire::JointAngleFrame wire;
  ASSERT_TRUE(Codec<body::JointAngleFrame>::Encode(frame, wire).ok());
  EXPECT_EQ(Codec<body::JointAngleFrame>::SerializedSize(wire), 4U + 320U);
}

TEST(PostureCodecTest, AJointThatIsNoneIsRefused) {
  wire::JointAngleFrame received;
  received.joints().resize(1);
  received.joints()[0].joint(15);
  ExpectCorrupt<body::JointAngleFrame>(
      received, "joint_angles.joint has 15 as its number, at most 14 are allowed");
}

TEST(PostureCodecTest, TextsBeyondTheirBoundsAreRefused) {
  ExpectOutOfBounds(body::BodyDefinition{.name = std::string(65, 'n')},
                    "body_definition.name has 65 characters, at most 64 are allowed");
  ExpectOutOfBounds(body::BodyDefinition{.reference_pose = std::string(17, 'p')},
                    "body_definition.reference_pose has 17 characters, at most 16 are allowed");
}

}  // namespace
}  // namespace limbcast::bus::testing
