#include "common/simulation/person_shape.hpp"

#include <gtest/gtest.h>

#include "common/body/default_body.hpp"

namespace limbcast::simulation {
namespace {

TEST(PersonShapeTest, TakesTheNumbersOfTheBodyDefinition) {
  const auto shape = MakePersonShape(1.75);
  ASSERT_TRUE(shape.ok());
  EXPECT_NEAR(shape->leg_m() + shape->ankle_height_m, body::kStandingRootHeight * 1.75, 1e-12);
  EXPECT_NEAR(shape->ankle_height_m, 0.039 * 1.75, 1e-12);
  EXPECT_NEAR(shape->ball_forward_m, 0.075 * 1.75, 1e-12);
  EXPECT_NEAR(shape->ball_height_m, 0.012 * 1.75, 1e-12);
  EXPECT_NEAR(shape->hip_half_m, 0.05 * 1.75, 1e-12);
}

TEST(PersonShapeTest, RefusesWhatCannotWalk) {
  EXPECT_FALSE(MakePersonShape(0.9).ok());
  EXPECT_FALSE(MakePersonShape(std::nan("")).ok());

  auto body = *body::MakeDefaultBody(BodyId{1});
  auto missing = body;
  missing.segments.pop_back();
  EXPECT_NE(MakePersonShape(missing).error().message.find("left_toe"), std::string::npos);

  auto lame = body;
  lame.segments[body::Index(body::Segment::kRightFoot)].p_parent_segment_m.z() -= 0.05;
  EXPECT_NE(MakePersonShape(lame).error().message.find("alike"), std::string::npos);

  auto crooked = body;
  crooked.segments[body::Index(body::Segment::kLeftLowerLeg)].p_parent_segment_m.x() = 0.1;
  EXPECT_NE(MakePersonShape(crooked).error().message.find("straight"), std::string::npos);
}

}  // namespace
}  // namespace limbcast::simulation
