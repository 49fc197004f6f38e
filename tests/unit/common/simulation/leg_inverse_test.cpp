#include "common/simulation/leg_inverse.hpp"

#include <gtest/gtest.h>

#include <numbers>

namespace limbcast::simulation {
namespace {

constexpr double kUpper_m = 0.42;
constexpr double kLower_m = 0.44;
constexpr double kDeg = std::numbers::pi / 180.0;

TEST(LegInverseTest, BonesReachTheAnkle) {
  const Jet3 reach_m = {0.15, -0.03, -0.75};
  const Jet distance_m = Sqrt(Dot(reach_m, reach_m));
  const Jet knee_rad = KneeFlexion(distance_m, kUpper_m, kLower_m);
  const LegAxes leg =
      SolveLeg(Inverse(distance_m) * reach_m, {1.0, 0.0, 0.0}, knee_rad, kUpper_m, kLower_m);
  const Jet3 ankle_m = (-kUpper_m) * leg.upper_z + (-kLower_m) * leg.lower_z;
  EXPECT_NEAR(ankle_m.x.value, 0.15, 1e-12);
  EXPECT_NEAR(ankle_m.y.value, -0.03, 1e-12);
  EXPECT_NEAR(ankle_m.z.value, -0.75, 1e-12);
  EXPECT_NEAR(Dot(leg.upper_z, leg.hinge).value, 0.0, 1e-12);
  EXPECT_GT(leg.upper_x.x.value, 0.7);                      // the knee points forward
  EXPECT_GT(Cross(leg.upper_z, leg.lower_z).y.value, 0.0);  // and bends backward: +y
}

TEST(LegInverseTest, KneeFlexionInvertsTheDistance) {
  for (double knee_rad = 9.5 * kDeg; knee_rad < 120.0 * kDeg; knee_rad += 10.0 * kDeg) {
    const Jet knee{knee_rad, 0.7, -0.3};
    const Jet back = KneeFlexion(HipToAnkle(knee, kUpper_m, kLower_m), kUpper_m, kLower_m);
    EXPECT_NEAR(back.value, knee.value, 1e-9);
    EXPECT_NEAR(back.rate, knee.rate, 1e-9);
    EXPECT_NEAR(back.accel, knee.accel, 1e-7);
  }
}

TEST(LegInverseTest, AStraightLegIsStraightDown) {
  const Jet knee{0.0, 0.0, 0.4};
  EXPECT_NEAR(HipToAnkle(knee, kUpper_m, kLower_m).value, kUpper_m + kLower_m, 1e-15);
  const LegAxes leg = SolveLeg({0.0, 0.0, -1.0}, {1.0, 0.0, 0.0}, knee, kUpper_m, kLower_m);
  EXPECT_EQ(leg.upper_z.z.value, 1.0);
  EXPECT_EQ(leg.lower_x.x.value, 1.0);
  EXPECT_EQ(leg.hinge.y.value, 1.0);
}

TEST(LegInverseTest, AnOverstretchedLegStaysBentAndFinite) {
  const Jet knee = KneeFlexion({1.2, 1.0, 5.0}, kUpper_m, kLower_m);
  EXPECT_GT(knee.value, 3.0 * kDeg);
  EXPECT_LT(knee.value, 5.0 * kDeg);
  EXPECT_EQ(knee.rate, 0.0);
}

}  // namespace
}  // namespace limbcast::simulation
