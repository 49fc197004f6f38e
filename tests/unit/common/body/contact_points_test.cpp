#include "common/body/contact_points.hpp"

#include <gtest/gtest.h>

#include <array>

#include "common/body/default_body.hpp"
#include "common/body/forward_kinematics.hpp"

namespace limbcast::body {
namespace {

class ContactPointsTest : public ::testing::Test {
 protected:
  /// Height of the underside of each point over the floor while standing in the reference pose.
  static std::vector<double> Heights(const BodyDefinition& body) {
    BodyPose pose;
    ForwardKinematics(body).Place({0.0, 0.0, kStandingRootHeight * kDefaultBodyHeight_m}, pose);
    std::vector<double> heights_m;
    for (const ContactPoint& point : MakeContactPoints(body)) {
      heights_m.push_back(
          (pose.p_earth_segment_m[Index(point.segment)] + point.p_segment_point_m).z() -
          point.radius_m);
    }
    return heights_m;
  }
};

TEST_F(ContactPointsTest, HeelsAndBallsOfAStandingPersonAreOnTheFloor) {
  const BodyDefinition body = *MakeDefaultBody(BodyId{1});
  const auto points = MakeContactPoints(body);
  const auto heights_m = Heights(body);
  ASSERT_EQ(points.size(), 7U);
  for (std::size_t i = 0; i < points.size(); ++i) {
    const bool foot =
        points[i].segment == Segment::kRightFoot || points[i].segment == Segment::kLeftFoot;
    if (foot) {
      EXPECT_NEAR(heights_m[i], 0.0, 1e-12);
    } else {
      EXPECT_GT(heights_m[i], 0.3) << "knees and seat are not";
    }
  }
}

TEST_F(ContactPointsTest, WithoutToesTheSoleIsWhereItWas) {
  std::vector<Segment> kept(ReducedSegments().begin(), ReducedSegments().end());
  const BodyDefinition body = KeepSegments(*MakeDefaultBody(BodyId{1}), kept);
  const auto points = MakeContactPoints(body);
  const auto heights_m = Heights(body);
  ASSERT_EQ(points.size(), 7U);
  EXPECT_NEAR(heights_m[0], 0.0, 1e-12);
  EXPECT_NEAR(heights_m[1], 0.0, 1e-12);
  EXPECT_EQ(points[1].contacts, 1U << Index(Segment::kRightFoot));
}

TEST_F(ContactPointsTest, APersonWithoutLegsTouchesNothing) {
  const std::array<Segment, 2> kept = {Segment::kT8, Segment::kHead};
  EXPECT_TRUE(MakeContactPoints(KeepSegments(*MakeDefaultBody(BodyId{1}), kept)).empty());
}

TEST_F(ContactPointsTest, LeftAndRightAreMirrored) {
  const auto points = MakeContactPoints(*MakeDefaultBody(BodyId{1}));
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_EQ(points[i].p_segment_point_m, points[i + 3].p_segment_point_m);
    EXPECT_NEAR(points[i].radius_m, points[i + 3].radius_m, 1e-12);
    EXPECT_EQ(points[i].contacts << 4U, points[i + 3].contacts);
  }
}

}  // namespace
}  // namespace limbcast::body
