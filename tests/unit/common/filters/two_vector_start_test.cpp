#include "common/filters/two_vector_start.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "common/math/rotation.hpp"

namespace limbcast::filters {
namespace {

using Eigen::Quaterniond;
using Eigen::Vector3d;

const Vector3d kField_tesla(0.0, 19e-6, -44e-6);
const Vector3d kForce_m_s2(0.0, 0.0, 9.81);

Quaterniond RandomQuaternion(std::mt19937& rng) {
  std::normal_distribution<double> normal;
  return Quaterniond(normal(rng), normal(rng), normal(rng), normal(rng)).normalized();
}

TEST(TwoVectorStartTest, IsNeverWrongInAHundredThousandRandomOrientations) {
  std::mt19937 rng(21);
  double worst_rad = 0.0;
  for (int trial = 0; trial < 100'000; ++trial) {
    const Quaterniond q = RandomQuaternion(rng);
    const auto start =
        OrientationFromTwoVectors(q.conjugate() * kForce_m_s2, q.conjugate() * kField_tesla);
    ASSERT_TRUE(start.has_value());
    worst_rad = std::max(worst_rad, math::AngleBetween_rad(*start, q));
  }
  EXPECT_LT(worst_rad, 1e-13);
}

TEST(TwoVectorStartTest, RefusesWhatHasNoDirection) {
  EXPECT_FALSE(OrientationFromTwoVectors(Vector3d::Zero(), kField_tesla));
  EXPECT_FALSE(OrientationFromTwoVectors(kForce_m_s2, Vector3d::Zero()));
  EXPECT_FALSE(OrientationFromTwoVectors(kForce_m_s2, Vector3d(0.0, 1e-12, 1e-5)));
  EXPECT_FALSE(OrientationFromTwoVectors(Vector3d::Constant(NAN), kField_tesla));
  EXPECT_FALSE(OrientationFromUpright(Vector3d::Zero()));
}

TEST(TwoVectorStartTest, WithoutFieldItIsUprightWithHeadingZero) {
  std::mt19937 rng(22);
  for (int trial = 0; trial < 1000; ++trial) {
    const Quaterniond q = RandomQuaternion(rng);
    const Vector3d up_S = q.conjugate() * Vector3d::UnitZ();
    const auto start = OrientationFromUpright(9.81 * up_S);
    ASSERT_TRUE(start.has_value());
    EXPECT_LT((*start * up_S - Vector3d::UnitZ()).norm(), 1e-12);
    EXPECT_NEAR(math::Heading_rad(*start), 0.0, 1e-12);
  }
  const auto upside_down = OrientationFromUpright({0.0, 0.0, -9.81});
  ASSERT_TRUE(upside_down.has_value());
  EXPECT_LT((*upside_down * Vector3d(0.0, 0.0, -1.0) - Vector3d::UnitZ()).norm(), 1e-12);
}

TEST(TwoVectorStartTest, AveragesWhileTheSensorTurns) {
  std::mt19937 rng(23);
  TwoVectorStart start;
  Quaterniond q = RandomQuaternion(rng);
  const Vector3d rate_rad_s(2.0, -1.0, 3.0);
  const double dt_s = 0.01;
  for (int i = 0; i < 50; ++i) {
    q = q * math::ExpSO3(rate_rad_s * dt_s);
    const Vector3d accel_m_s2 = q.conjugate() * kForce_m_s2;
    const Vector3d mag_tesla = q.conjugate() * kField_tesla;
    start.Add(rate_rad_s, dt_s, &accel_m_s2, &mag_tesla);
  }
  EXPECT_TRUE(start.complete(0.49));
  const auto solved = start.Solve();
  ASSERT_TRUE(solved.has_value());
  EXPECT_LT(math::AngleBetween_rad(solved->q_earth_sensor, q), 1e-12);
  EXPECT_LT((solved->mag_in_earth_tesla - kField_tesla).norm(), 1e-17);
}

TEST(TwoVectorStartTest, NeedsAnAccelerometerReading) {
  TwoVectorStart start;
  const Vector3d mag_tesla = kField_tesla;
  start.Add(Vector3d::Zero(), 1.0, nullptr, &mag_tesla);
  EXPECT_FALSE(start.Solve());
}

TEST(ReferenceFieldTest, PointsNorthWithTheSameDipAndLength) {
  const Vector3d reference = ReferenceField({3.0, 4.0, -12.0});
  EXPECT_EQ(reference, Vector3d(0.0, 5.0, -12.0));
}

}  // namespace
}  // namespace limbcast::filters
