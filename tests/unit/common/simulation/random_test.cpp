#include "common/simulation/random.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "common/math/rotation.hpp"

namespace limbcast::simulation {
namespace {

TEST(RandomTest, IsTheSameEverywhere) {
  // SplitMix64 and xoshiro256++ 1.0 written by hand in another language (Python), seed 42.
  Random random(42);
  EXPECT_EQ(random.Next(), 15021278609987233951ULL);
  EXPECT_EQ(random.Next(), 5881210131331364753ULL);
  EXPECT_EQ(random.Next(), 18149643915985481100ULL);
}

TEST(RandomTest, PartsHaveStreamsOfTheirOwn) {
  Random a(7, "gyro");
  Random b(7, "gyro");
  Random c(7, "accel");
  Random d(8, "gyro");
  const std::uint64_t first = a.Next();
  EXPECT_EQ(first, b.Next());
  EXPECT_NE(first, c.Next());
  EXPECT_NE(first, d.Next());
}

TEST(RandomTest, MomentsAreRight) {
  Random random(1);
  constexpr int kCount = 200'000;
  double sum = 0.0;
  double square = 0.0;
  double fourth = 0.0;
  double even = 0.0;
  for (int i = 0; i < kCount; ++i) {
    const double g = random.Gaussian();
    sum += g;
    square += g * g;
    fourth += g * g * g * g;
    even += random.Uniform(2.0, 4.0);
  }
  EXPECT_NEAR(sum / kCount, 0.0, 0.01);
  EXPECT_NEAR(square / kCount, 1.0, 0.015);
  EXPECT_NEAR(fourth / kCount, 3.0, 0.1);
  EXPECT_NEAR(even / kCount, 3.0, 0.006);
}

TEST(RandomTest, RotationsAreEven) {
  Random random(3);
  Eigen::Matrix3d mean = Eigen::Matrix3d::Zero();
  double angle_rad = 0.0;
  constexpr int kCount = 20'000;
  for (int i = 0; i < kCount; ++i) {
    const Eigen::Quaterniond q = random.Rotation();
    ASSERT_NEAR(q.norm(), 1.0, 1e-12);
    mean += q.toRotationMatrix() / kCount;
    angle_rad += math::AngleBetween_rad(q, Eigen::Quaterniond::Identity()) / kCount;
  }
  EXPECT_LT(mean.norm(), 0.03);
  EXPECT_NEAR(angle_rad, M_PI / 2.0 + 2.0 / M_PI, 0.02);  // mean angle of a random rotation
}

}  // namespace
}  // namespace limbcast::simulation
