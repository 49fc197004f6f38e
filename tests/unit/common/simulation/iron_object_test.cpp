#include "common/simulation/iron_object.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace limbcast::simulation {
namespace {

using Eigen::Vector3d;

TEST(IronObjectTest, ABallHasTheRadiusOfItsMass) {
  const double radius_m = IronBallRadius_m(3.75);
  EXPECT_NEAR(4.0 / 3.0 * 3.14159265358979 * std::pow(radius_m, 3) * 7870.0, 3.75, 1e-9);
  EXPECT_NEAR(radius_m, 0.0485, 1e-4);
}

// The boundary condition of a sphere with μ → ∞: outside, the field stands upright on its surface,
// three times as strong at the poles as far away, and gone at the equator.
TEST(IronObjectTest, FieldLinesMeetTheSurfaceOfABallAtRightAngles) {
  MagneticWorld world;
  const Vector3d center_m(0.3, -0.2, 1.0);
  world.iron.push_back(MakeIronBall(5.0, center_m, Vector3d::Zero(), world.earth));
  const double radius_m = IronBallRadius_m(5.0);
  Random random(3);
  for (int i = 0; i < 100; ++i) {
    const Vector3d normal = random.Gaussian3().normalized();
    const Vector3d field_tesla = world.At(center_m + radius_m * normal);
    EXPECT_LT(field_tesla.cross(normal).norm(), 1e-6 * world.earth.norm_tesla);
  }
  const Vector3d along = EarthField_tesla(world.earth).normalized();
  EXPECT_NEAR(world.At(center_m + radius_m * along).norm(), 3.0 * world.earth.norm_tesla, 1e-11);
}

TEST(IronObjectTest, WhatABallKeepsComesOnTop) {
  const EarthField earth;
  const Vector3d kept_a_m2(0.1, 0.0, -0.05);
  const IronZone with = MakeIronBall(2.0, Vector3d::Zero(), kept_a_m2, earth);
  const IronZone without = MakeIronBall(2.0, Vector3d::Zero(), Vector3d::Zero(), earth);
  EXPECT_LT((with.moment_a_m2 - without.moment_a_m2 - kept_a_m2).norm(), 1e-15);
}

TEST(IronObjectTest, ACaseIsFilledWithDipolesThatCarryTheMomentOfAShell) {
  IronCase box;
  box.size_m = {0.7, 0.35, 0.9};
  box.p_earth_center_m = {0.0, 1.0, 0.45};
  Random random(4);
  const EarthField earth;
  const auto zones = MakeIronCase(box, earth, random);
  EXPECT_EQ(zones.size(), 4U * 2U * 5U);
  Vector3d sum_a_m2 = Vector3d::Zero();
  for (const IronZone& zone : zones) {
    EXPECT_TRUE(
        ((zone.p_earth_iron_m - box.p_earth_center_m).array().abs() < 0.5 * box.size_m.array())
            .all());
    sum_a_m2 += zone.moment_a_m2;
  }
  // s = ⅔·200·1.5 mm/a with a = 0.375 m: 0.53; m = 3VB/μ₀·s/(1 + s) = 9 A·m².
  EXPECT_NEAR(sum_a_m2.norm(), 9.0, 0.5);
  EXPECT_LT(sum_a_m2.normalized().cross(EarthField_tesla(earth).normalized()).norm(), 1e-12);
}

TEST(IronObjectTest, RemanenceDiffersFromPlaceToPlaceAndIsTheSameForTheSameSeed) {
  IronCase box;
  box.remanence_a_m = 1e4;
  Random first(5);
  Random second(5);
  const auto a = MakeIronCase(box, {}, first);
  const auto b = MakeIronCase(box, {}, second);
  ASSERT_EQ(a.size(), b.size());
  for (std::size_t i = 0; i < a.size(); ++i) {
    EXPECT_EQ(a[i].moment_a_m2, b[i].moment_a_m2);
  }
  EXPECT_GT((a[0].moment_a_m2 - a[1].moment_a_m2).norm(), 1e-3);
}

}  // namespace
}  // namespace limbcast::simulation
