#include "common/body/body_definition.hpp"

#include <gtest/gtest.h>

#include "common/body/default_body.hpp"

namespace limbcast::body {
namespace {

TEST(BodyDefinitionTest, ASegmentIsFoundWhereverItsRowIsAndOneThatIsNotThereIsNot) {
  BodyDefinition body = KeepSegments(*MakeDefaultBody(BodyId{1}), ReducedSegments());
  ASSERT_NE(Find(body, Segment::kLeftFoot), nullptr);
  EXPECT_EQ(Find(body, Segment::kLeftFoot)->segment, Segment::kLeftFoot);
  EXPECT_EQ(Find(body, Segment::kLeftToe), nullptr);
  Find(body, Segment::kLeftFoot)->aligned = true;
  EXPECT_TRUE(body.segments.back().aligned) << "it is the row itself";
}

TEST(BodyDefinitionTest, DimensionsAndAlignmentAreTakenOverApart) {
  SegmentDefinition from;
  from.sensor_uid = SensorUid{5};
  from.p_parent_segment_m = {1.0, 0.0, 0.0};
  from.p_segment_end_m = {0.0, 2.0, 0.0};
  from.length_measured = true;
  from.q_sensor_segment = Eigen::Quaterniond(0.0, 1.0, 0.0, 0.0);
  from.heading_correction_rad = 0.5;
  from.aligned = true;
  from.alignment_quality = 0.25F;

  SegmentDefinition dimensions;
  TakeDimensions(from, dimensions);
  EXPECT_EQ(dimensions.p_parent_segment_m, from.p_parent_segment_m);
  EXPECT_EQ(dimensions.p_segment_end_m, from.p_segment_end_m);
  EXPECT_TRUE(dimensions.length_measured);
  EXPECT_FALSE(dimensions.aligned);

  SegmentDefinition alignment;
  alignment.sensor_uid = SensorUid{7};
  TakeAlignment(from, alignment);
  EXPECT_EQ(alignment.q_sensor_segment.coeffs(), from.q_sensor_segment.coeffs());
  EXPECT_EQ(alignment.heading_correction_rad, 0.5);
  EXPECT_TRUE(alignment.aligned);
  EXPECT_EQ(alignment.alignment_quality, 0.25F);
  EXPECT_EQ(alignment.sensor_uid, SensorUid{7});
  EXPECT_FALSE(alignment.length_measured);

  TakeAlignment(SegmentDefinition(), alignment);
  EXPECT_FALSE(alignment.aligned);
  EXPECT_EQ(alignment.alignment_quality, 1.0F);
}

}  // namespace
}  // namespace limbcast::body
