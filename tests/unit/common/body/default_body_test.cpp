#include "common/body/default_body.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <vector>

namespace limbcast::body {
namespace {

using ::testing::HasSubstr;

const SegmentDefinition& Of(const BodyDefinition& body, Segment segment) {
  for (const SegmentDefinition& definition : body.segments) {
    if (definition.segment == segment) {
      return definition;
    }
  }
  ADD_FAILURE() << "no " << ToString(segment);
  return body.segments.front();
}

/// Inboard end over the floor in the reference pose.
Eigen::Vector3d Standing(const BodyDefinition& body, Segment segment, double root_height_m) {
  Eigen::Vector3d p_m = Eigen::Vector3d(0.0, 0.0, root_height_m);
  for (int i = static_cast<int>(&Of(body, segment) - body.segments.data()); i >= 0;
       i = ParentIndex(body, body.segments[static_cast<std::size_t>(i)].segment)) {
    p_m += body.segments[static_cast<std::size_t>(i)].p_parent_segment_m;
  }
  return p_m;
}

TEST(DefaultBodyTest, HasAllSegmentsParentsFirstAndIsValidAtEveryHeight) {
  for (const double height_m : {kMinBodyHeight_m, 1.2, 1.75, kMaxBodyHeight_m}) {
    const auto body = MakeDefaultBody(BodyId{3}, height_m);
    ASSERT_TRUE(body.ok());
    EXPECT_EQ(body->body_id, BodyId{3});
    EXPECT_EQ(body->segments.size(), kSegmentCount);
    EXPECT_TRUE(Validate(*body).ok());
    EXPECT_NEAR(StandingHeight_m(*body), height_m, 1e-9);
  }
}

TEST(DefaultBodyTest, LengthsAreThePublishedFractionsOfHeight) {
  const BodyDefinition body = *MakeDefaultBody(BodyId{1}, 2.0);
  const auto length = [&](Segment segment) { return Of(body, segment).p_segment_end_m.norm() / 2; };
  // Drillis & Contini 1966, Winter 2009 Fig. 4.1.
  EXPECT_NEAR(length(Segment::kLeftUpperArm), 0.186, 1e-12);
  EXPECT_NEAR(length(Segment::kRightForeArm), 0.146, 1e-12);
  EXPECT_NEAR(length(Segment::kLeftHand), 0.108, 1e-12);
  EXPECT_NEAR(length(Segment::kRightUpperLeg), 0.530 - 0.285, 1e-12);
  EXPECT_NEAR(length(Segment::kLeftLowerLeg), 0.285 - 0.039, 1e-12);
  const double root_m = 2.0 * kStandingRootHeight;
  EXPECT_NEAR(Standing(body, Segment::kLeftFoot, root_m).z(), 2.0 * 0.039, 1e-12);
  EXPECT_NEAR(Standing(body, Segment::kLeftUpperArm, root_m).y(), 2.0 * 0.129, 1e-12);
}

TEST(DefaultBodyTest, LeftIsTheMirrorOfRight) {
  const BodyDefinition body = *MakeDefaultBody(BodyId{1});
  for (const std::size_t right : {7U, 8U, 9U, 10U, 15U, 16U, 17U, 18U}) {
    const SegmentDefinition& r = body.segments[right];
    const SegmentDefinition& l = body.segments[right + 4];
    const Eigen::Vector3d mirror(1.0, -1.0, 1.0);
    EXPECT_TRUE(r.p_parent_segment_m.cwiseProduct(mirror).isApprox(l.p_parent_segment_m));
    EXPECT_TRUE(r.p_segment_end_m.cwiseProduct(mirror).isApprox(l.p_segment_end_m));
    EXPECT_GE(l.p_segment_end_m.y(), 0.0) << "left is +y";
  }
}

TEST(DefaultBodyTest, RefusesAHeightThatNobodyHasAndNamesTheLimit) {
  for (const double height_m : {0.0, 0.49, 2.51, std::numeric_limits<double>::quiet_NaN()}) {
    const auto body = MakeDefaultBody(BodyId{1}, height_m);
    ASSERT_FALSE(body.ok());
    EXPECT_THAT(body.error().message, HasSubstr("height must be in [0.5, 2.5] m"));
  }
}

TEST(DefaultBodyTest, TheSixteenAreThePapersFifteenAndTheLowerBack) {
  const auto sixteen = SixteenSegments();
  ASSERT_EQ(sixteen.size(), 16U);
  EXPECT_EQ(sixteen[0], Segment::kPelvis);
  EXPECT_EQ(sixteen[1], Segment::kL5);
  EXPECT_TRUE(std::equal(sixteen.begin() + 2, sixteen.end(), ReducedSegments().begin() + 1,
                         ReducedSegments().end()));
}

TEST(DefaultBodyTest, LeavingSegmentsOutMovesNoJoint) {
  const BodyDefinition full = *MakeDefaultBody(BodyId{1});
  const BodyDefinition reduced = KeepSegments(full, ReducedSegments());
  ASSERT_EQ(reduced.segments.size(), 15U);
  EXPECT_TRUE(Validate(reduced).ok());
  for (const SegmentDefinition& definition : reduced.segments) {
    EXPECT_TRUE(Standing(reduced, definition.segment, 1.0)
                    .isApprox(Standing(full, definition.segment, 1.0), 1e-12))
        << ToString(definition.segment);
  }
}

TEST(DefaultBodyTest, ALongerSegmentMovesTheJointsAtItsEnd) {
  BodyDefinition body = *MakeDefaultBody(BodyId{1});
  const Eigen::Vector3d foot_m = Standing(body, Segment::kLeftFoot, 1.0);
  const double before_m = Of(body, Segment::kLeftLowerLeg).p_segment_end_m.norm();
  ASSERT_TRUE(SetDimension("left_lower_leg", before_m + 0.05, body).ok());
  EXPECT_NEAR(Standing(body, Segment::kLeftFoot, 1.0).z(), foot_m.z() - 0.05, 1e-12);
  EXPECT_TRUE(Validate(body).ok());
}

TEST(DefaultBodyTest, HeightKeepsAlignmentAndSegments) {
  BodyDefinition body = KeepSegments(*MakeDefaultBody(BodyId{1}), ReducedSegments());
  body.segments[2].aligned = true;
  ASSERT_TRUE(SetDimension("height", 1.9, body).ok());
  EXPECT_TRUE(body.segments[2].aligned);
  EXPECT_EQ(body.segments.size(), 15U);
  EXPECT_NEAR(Of(body, Segment::kLeftUpperArm).p_segment_end_m.norm(), 1.9 * 0.186, 1e-12);
}

double Length(const BodyDefinition& body, Segment segment) {
  return Of(body, segment).p_segment_end_m.norm();
}

TEST(DefaultBodyTest, TheOtherSideIsAsLongUnlessItWasMeasuredItself) {
  BodyDefinition body = *MakeDefaultBody(BodyId{1});
  ASSERT_TRUE(SetDimension("right_lower_leg", 0.45, body).ok());
  EXPECT_NEAR(Length(body, Segment::kLeftLowerLeg), 0.45, 1e-12);
  ASSERT_TRUE(SetDimension("left_lower_leg", 0.44, body).ok());
  EXPECT_NEAR(Length(body, Segment::kRightLowerLeg), 0.45, 1e-12);
  ASSERT_TRUE(SetDimension("right_lower_leg", 0.46, body).ok());
  EXPECT_NEAR(Length(body, Segment::kLeftLowerLeg), 0.44, 1e-12);
  EXPECT_NEAR(Length(body, Segment::kLeftUpperArm), 0.186 * kDefaultBodyHeight_m, 1e-12);
}

TEST(DefaultBodyTest, MeasuredLengthsStayAndTheRestFitsTheHeight) {
  BodyDefinition body = *MakeDefaultBody(BodyId{1}, 1.75);
  ASSERT_TRUE(SetDimension("right_lower_leg", 0.50, body).ok());  // 7 cm more than usual
  ASSERT_TRUE(SetDimension("left_fore_arm", 0.30, body).ok());
  ASSERT_TRUE(SetDimension("height", 1.80, body).ok());
  EXPECT_NEAR(StandingHeight_m(body), 1.80, 1e-9);
  EXPECT_NEAR(Length(body, Segment::kRightLowerLeg), 0.50, 1e-12);
  EXPECT_NEAR(Length(body, Segment::kLeftLowerLeg), 0.50, 1e-12);
  EXPECT_NEAR(Length(body, Segment::kLeftForeArm), 0.30, 1e-12);
  EXPECT_NEAR(Length(body, Segment::kLeftUpperArm), 0.186 * 1.80, 1e-12) << "arms add no height";
  // The rest of the height, without shanks and feet, shares what is missing alike.
  const double rest = (1.80 - 0.50 - 0.039 * 1.80) / (1.80 * (1.0 - 0.246 - 0.039));
  EXPECT_NEAR(Length(body, Segment::kLeftUpperLeg), rest * 0.245 * 1.80, 1e-9);
  EXPECT_NEAR(Length(body, Segment::kHead), rest * 0.100 * 1.80, 1e-9);
  EXPECT_TRUE(Validate(body).ok());
}

TEST(DefaultBodyTest, AHeightThatMeasuredLengthsDoNotLeaveRoomForIsRefused) {
  BodyDefinition body = *MakeDefaultBody(BodyId{1}, 1.75);
  ASSERT_TRUE(SetDimension("right_lower_leg", 0.90, body).ok());
  const double before_m = StandingHeight_m(body);
  const Status refused = SetDimension("height", 1.75, body);
  ASSERT_FALSE(refused.ok());
  EXPECT_THAT(refused.error().message, HasSubstr("do not fit a height of 1.75 m"));
  EXPECT_EQ(StandingHeight_m(body), before_m) << "nothing changed";
}

TEST(DefaultBodyTest, RefusesUnknownNamesAndLengths) {
  BodyDefinition body = *MakeDefaultBody(BodyId{1});
  const Status name = SetDimension("tail", 0.3, body);
  ASSERT_FALSE(name.ok());
  EXPECT_THAT(name.error().message, HasSubstr("tail"));
  const Status length = SetDimension("left_hand", 3.0, body);
  ASSERT_FALSE(length.ok());
  EXPECT_THAT(length.error().message, HasSubstr("left_hand must be in [0.01, 1] m, is 3"));
}

TEST(DefaultBodyTest, ValidateNamesWhatIsWrong) {
  const BodyDefinition good = *MakeDefaultBody(BodyId{1});
  const auto message = [](const BodyDefinition& body) {
    const Status status = Validate(body);
    return status.ok() ? std::string() : status.error().message;
  };
  BodyDefinition body = good;
  body.segments.clear();
  EXPECT_THAT(message(body), HasSubstr("pelvis"));
  body = good;
  body.segments.push_back(good.segments.back());
  EXPECT_THAT(message(body), HasSubstr("left_toe is there twice"));
  body = good;
  std::swap(body.segments[8], body.segments[9]);
  EXPECT_THAT(message(body), HasSubstr("right_fore_arm must come after its parent"));
  body = good;
  body.segments[4].p_segment_end_m.x() = std::numeric_limits<double>::infinity();
  EXPECT_THAT(message(body), HasSubstr("t8"));
  body = good;
  body.segments[1].q_sensor_segment.w() = 0.5;
  EXPECT_THAT(message(body), HasSubstr("q_sensor_segment of l5"));
}

}  // namespace
}  // namespace limbcast::body
