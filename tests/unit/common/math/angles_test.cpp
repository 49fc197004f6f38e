#include "common/math/angles.hpp"

#include <gtest/gtest.h>

#include <numbers>

namespace limbcast::math {
namespace {

constexpr double kPi = std::numbers::pi;

TEST(AnglesTest, AnAngleIsWrappedIntoHalfATurnBothWays) {
  EXPECT_NEAR(WrappedAngle_rad(0.3), 0.3, 1e-15);
  EXPECT_NEAR(WrappedAngle_rad(kPi + 0.1), -kPi + 0.1, 1e-12);
  EXPECT_NEAR(WrappedAngle_rad(-7.0 * kPi + 0.2), -kPi + 0.2, 1e-12);
}

TEST(AnglesTest, TheMeanKnowsThatTheCircleIsClosed) {
  AngleMean mean;
  EXPECT_EQ(mean.length(), 0.0);
  mean.Add(kPi - 0.1);
  mean.Add(-kPi + 0.3);
  EXPECT_NEAR(WrappedAngle_rad(mean.Mean_rad() - (kPi + 0.1)), 0.0, 1e-12);
  EXPECT_GT(mean.length(), 1.9);
}

TEST(AnglesTest, AWeightCountsAsSoManyAngles) {
  AngleMean weighted;
  weighted.Add(0.1);
  weighted.Add(0.9, 3.0);
  AngleMean repeated;
  repeated.Add(0.1);
  for (int i = 0; i < 3; ++i) {
    repeated.Add(0.9);
  }
  EXPECT_NEAR(weighted.Mean_rad(), repeated.Mean_rad(), 1e-14);
  EXPECT_GT(weighted.Mean_rad(), 0.5);
}

}  // namespace
}  // namespace limbcast::math
