#include "common/body/joint_limits.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <random>
#include <utility>

#include "common/math/rotation.hpp"

namespace limbcast::body {
namespace {

using Eigen::Quaterniond;
using Eigen::Vector3d;

constexpr double kDeg = std::numbers::pi / 180.0;
constexpr double kSoftness_rad = 0.1;

TEST(JointLimitsTest, ASoftClampIsTheIdentityWithinAndSaturatesBeyond) {
  EXPECT_EQ(SoftClamp(0.5, 0.0, 1.0, 0.1), 0.5);
  EXPECT_NEAR(SoftClamp(1.1, 0.0, 1.0, 0.1), 1.0 + 0.1 * (1.0 - std::exp(-1.0)), 1e-12);
  EXPECT_NEAR(SoftClamp(-0.1, 0.0, 1.0, 0.1), -0.1 * (1.0 - std::exp(-1.0)), 1e-12);
  EXPECT_NEAR(SoftClamp(99.0, 0.0, 1.0, 0.1), 1.1, 1e-12);
  EXPECT_EQ(SoftClamp(99.0, 1.0, 0.0, 0.1), 99.0) << "no limit";
  // Slope 1 on both sides of the limit.
  EXPECT_NEAR((SoftClamp(1.0 + 1e-6, 0.0, 1.0, 0.1) - 1.0) / 1e-6, 1.0, 1e-4);
}

TEST(JointLimitsTest, LeftAndRightHaveTheSameLimits) {
  for (std::size_t i = Index(Joint::kRightHip); i <= Index(Joint::kRightWrist); ++i) {
    const auto right = LimitsOf(static_cast<Joint>(i));
    const auto left = LimitsOf(static_cast<Joint>(i + 6));
    ASSERT_EQ(right.has_value(), left.has_value());
    if (right) {
      EXPECT_EQ(right->min_rad, left->min_rad);
      EXPECT_EQ(right->max_rad, left->max_rad);
      EXPECT_TRUE((right->min_rad.array() < 0.0).all() && (right->max_rad.array() > 0.0).all());
    }
  }
}

TEST(JointLimitsTest, WhatPeopleDoIsLeftAloneToTheLastBit) {
  // Sitting, a large step, toes down in push-off.
  for (const auto& [joint, angle_deg] : {std::pair{Joint::kRightHip, Vector3d(100, 10, -20)},
                                         std::pair{Joint::kLeftHip, Vector3d(-25, -20, 15)},
                                         std::pair{Joint::kRightAnkle, Vector3d(-45, 10, 5)},
                                         std::pair{Joint::kLeftWrist, Vector3d(60, 20, 20)}}) {
    const Quaterniond q = RotationOf(joint, angle_deg * kDeg);
    EXPECT_TRUE(SoftLimited(joint, q, kSoftness_rad).coeffs() == q.coeffs()) << ToString(joint);
  }
}

TEST(JointLimitsTest, NoAngleIsBeyondItsLimitByMoreThanTheSoftness) {
  std::mt19937 rng(20240517);
  std::uniform_real_distribution<double> outer(-170.0, 170.0);
  std::uniform_real_distribution<double> middle(-75.0, 75.0);
  for (const Joint joint : {Joint::kRightHip, Joint::kLeftHip, Joint::kRightAnkle,
                            Joint::kLeftAnkle, Joint::kRightWrist, Joint::kLeftWrist}) {
    const AngleLimits limits = *LimitsOf(joint);
    for (int trial = 0; trial < 200; ++trial) {
      const Vector3d given_rad = kDeg * Vector3d(outer(rng), middle(rng), outer(rng));
      const Quaterniond q = SoftLimited(joint, RotationOf(joint, given_rad), kSoftness_rad);
      const Vector3d is_rad = AnglesOf(joint, Quaterniond::Identity(), q).angle_rad;
      EXPECT_TRUE((is_rad.array() > limits.min_rad.array() - kSoftness_rad - 1e-9).all());
      EXPECT_TRUE((is_rad.array() < limits.max_rad.array() + kSoftness_rad + 1e-9).all());
      for (Eigen::Index i = 0; i < 3; ++i) {
        if (given_rad[i] > limits.min_rad[i] && given_rad[i] < limits.max_rad[i]) {
          EXPECT_NEAR(is_rad[i], given_rad[i], 1e-7) << "an angle within is as it was";
        }
      }
    }
  }
}

TEST(JointLimitsTest, JointsWithoutLimitsAndNearTheirSingularityAreLeftAlone) {
  const Quaterniond knee = RotationOf(Joint::kRightKnee, {-2.0, 0.0, 0.0});
  EXPECT_TRUE(SoftLimited(Joint::kRightKnee, knee, kSoftness_rad).coeffs() == knee.coeffs());
  const Quaterniond split = RotationOf(Joint::kRightHip, {0.0, -85.0 * kDeg, 2.0});
  EXPECT_TRUE(SoftLimited(Joint::kRightHip, split, kSoftness_rad).coeffs() == split.coeffs());
}

}  // namespace
}  // namespace limbcast::body
