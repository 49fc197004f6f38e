#include "common/math/rotation.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <random>

namespace limbcast::math {
namespace {

using Eigen::Matrix3d;
using Eigen::Quaterniond;
using Eigen::Vector3d;

constexpr double kPi = std::numbers::pi;

Vector3d RandomUnitVector(std::mt19937& rng) {
  std::normal_distribution<double> normal;
  return Vector3d(normal(rng), normal(rng), normal(rng)).normalized();
}

Quaterniond RandomQuaternion(std::mt19937& rng) {
  std::normal_distribution<double> normal;
  return Quaterniond(normal(rng), normal(rng), normal(rng), normal(rng)).normalized();
}

class ExpLogTest : public ::testing::TestWithParam<double> {};

TEST_P(ExpLogTest, LogUndoesExp) {
  std::mt19937 rng(20240517);
  for (int trial = 0; trial < 100; ++trial) {
    const Vector3d phi_rad = GetParam() * RandomUnitVector(rng);
    EXPECT_LT((LogSO3(ExpSO3(phi_rad)) - phi_rad).norm(), 1e-14 * (1.0 + GetParam()));
  }
}

TEST_P(ExpLogTest, ExpAgreesWithTheAxisAngleMatrixAndIsUnit) {
  std::mt19937 rng(20240518);
  for (int trial = 0; trial < 100; ++trial) {
    const Vector3d axis = RandomUnitVector(rng);
    const Quaterniond q = ExpSO3(GetParam() * axis);
    EXPECT_NEAR(q.norm(), 1.0, 1e-15 * 4.0);
    EXPECT_LT(
        (q.toRotationMatrix() - Eigen::AngleAxisd(GetParam(), axis).toRotationMatrix()).norm(),
        1e-14);
  }
}

INSTANTIATE_TEST_SUITE_P(Angles_rad, ExpLogTest,
                         ::testing::Values(0.0, 1e-9, 0.99e-4, 1.01e-4, 0.1, 1.0, 3.0, kPi - 1e-9));

TEST(LogSO3Test, TakesTheShortWayRound) {
  EXPECT_NEAR(LogSO3(ExpSO3({0.0, 0.0, 1.5 * kPi})).z(), -0.5 * kPi, 1e-15 * 8.0);
}

class RightJacobianSO3Test : public ::testing::TestWithParam<double> {};

TEST_P(RightJacobianSO3Test, MatchesCentralDifferences) {
  std::mt19937 rng(20240517);
  constexpr double kStep_rad = 1e-5;
  for (int trial = 0; trial < 100; ++trial) {
    const Vector3d phi_rad = GetParam() * RandomUnitVector(rng);
    Matrix3d numerical;
    for (int i = 0; i < 3; ++i) {
      const Vector3d step = kStep_rad * Vector3d::Unit(i);
      const Quaterniond centre_inverse = ExpSO3(phi_rad).conjugate();
      numerical.col(i) = (LogSO3(centre_inverse * ExpSO3(phi_rad + step)) -
                          LogSO3(centre_inverse * ExpSO3(phi_rad - step))) /
                         (2.0 * kStep_rad);
    }
    EXPECT_LT((RightJacobianSO3(phi_rad) - numerical).norm(), 1e-8)
        << "phi = " << phi_rad.transpose();
  }
}

INSTANTIATE_TEST_SUITE_P(Angles_rad, RightJacobianSO3Test,
                         ::testing::Values(0.0, 1e-9, 0.99e-4, 1.01e-4, 0.1, 1.0, 3.0));

TEST(QuaternionFromMatrixTest, EachOfTheFourPivotsIsReachedAndRight) {
  // w, x, y and z in turn are the largest component; near a half turn w is almost zero.
  const Quaterniond largest[] = {
      {0.9, 0.1, -0.2, 0.3}, {0.1, 0.9, -0.2, 0.3}, {-0.1, 0.2, 0.9, 0.3}, {0.1, -0.2, 0.3, 0.9}};
  for (const Quaterniond& raw : largest) {
    const Quaterniond q = raw.normalized();
    EXPECT_LT(AngleBetween_rad(QuaternionFromMatrix(q.toRotationMatrix()), q), 1e-14);
  }
  for (int axis = 0; axis < 3; ++axis) {
    const Quaterniond half_turn = ExpSO3(kPi * Vector3d::Unit(axis));
    EXPECT_LT(AngleBetween_rad(QuaternionFromMatrix(half_turn.toRotationMatrix()), half_turn),
              1e-14);
  }
}

TEST(QuaternionFromMatrixTest, InvertsToRotationMatrixEverywhere) {
  std::mt19937 rng(20240519);
  for (int trial = 0; trial < 10'000; ++trial) {
    const Quaterniond q = RandomQuaternion(rng);
    ASSERT_LT(AngleBetween_rad(QuaternionFromMatrix(q.toRotationMatrix()), q), 1e-14);
  }
}

TEST(AngleBetweenTest, IsTheRotationAngleAndAtMostPi) {
  std::mt19937 rng(20240520);
  const Quaterniond q = RandomQuaternion(rng);
  EXPECT_NEAR(AngleBetween_rad(q, q * ExpSO3({0.0, 0.7, 0.0})), 0.7, 1e-14);
  EXPECT_NEAR(AngleBetween_rad(q, q * ExpSO3({0.0, kPi + 0.2, 0.0})), kPi - 0.2, 1e-14);
}

TEST(NearestSignTest, KeepsTheOrientationAndFacesTheReference) {
  std::mt19937 rng(20240521);
  for (int trial = 0; trial < 100; ++trial) {
    const Quaterniond a = RandomQuaternion(rng);
    const Quaterniond b = RandomQuaternion(rng);
    const Quaterniond nearest = NearestSign(a, b);
    EXPECT_GE(nearest.dot(b), 0.0);
    EXPECT_LT(AngleBetween_rad(nearest, a), 1e-15 * 8.0);
  }
}

TEST(SlerpTest, RunsAtConstantRateAlongTheShorterArc) {
  const Quaterniond a = ExpSO3({0.1, 0.2, 0.3});
  const Quaterniond b_far = a * ExpSO3({0.0, 1.2, 0.0});
  const Quaterniond b(-b_far.w(), -b_far.x(), -b_far.y(), -b_far.z());
  for (const double t : {-0.5, 0.0, 0.25, 0.5, 1.0, 1.5}) {
    EXPECT_LT(AngleBetween_rad(Slerp(a, b, t), a * ExpSO3({0.0, 1.2 * t, 0.0})), 1e-14);
  }
}

}  // namespace
}  // namespace limbcast::math
