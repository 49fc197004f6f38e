#include "common/body/sensor_place.hpp"

#include <gtest/gtest.h>

#include "common/body/default_body.hpp"

namespace limbcast::body {
namespace {

TEST(SensorPlaceTest, RightIsTheMirrorImageOfLeft) {
  for (const auto& [right, left] : {std::pair{Segment::kRightForeArm, Segment::kLeftForeArm},
                                    std::pair{Segment::kRightLowerLeg, Segment::kLeftLowerLeg},
                                    std::pair{Segment::kRightShoulder, Segment::kLeftShoulder},
                                    std::pair{Segment::kRightToe, Segment::kLeftToe}}) {
    Eigen::Vector3d mirrored_m = SkinOffset_m(left);
    mirrored_m.y() = -mirrored_m.y();
    EXPECT_EQ(SkinOffset_m(right), mirrored_m) << ToString(right);
  }
}

TEST(SensorPlaceTest, ASensorSitsOnTheSkinInTheMiddleOfItsSegment) {
  const auto body = MakeDefaultBody(BodyId{1});
  const SegmentDefinition* const shank = Find(*body, Segment::kLeftLowerLeg);
  const Eigen::Vector3d place_m = UsualSensorPlace_m(*body, Segment::kLeftLowerLeg);
  EXPECT_DOUBLE_EQ(place_m.z(), 0.5 * shank->p_segment_end_m.z());
  EXPECT_GT(place_m.y(), 0.0);
}

TEST(SensorPlaceTest, OfASegmentThatIsNotThereNothingIsKnown) {
  BodyDefinition pelvis_only = KeepSegments(*MakeDefaultBody(BodyId{1}), {});
  EXPECT_TRUE(UsualSensorPlace_m(pelvis_only, Segment::kLeftHand).isZero());
}

}  // namespace
}  // namespace limbcast::body
