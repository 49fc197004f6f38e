#include "common/body/forward_kinematics.hpp"

#include <gtest/gtest.h>

#include <numbers>
#include <random>
#include <tuple>

#include "common/body/alignment.hpp"
#include "common/body/default_body.hpp"
#include "common/body/joint_limits.hpp"
#include "common/math/rotation.hpp"

namespace limbcast::body {
namespace {

using Eigen::Quaterniond;
using Eigen::Vector3d;

Quaterniond RandomQuaternion(std::mt19937& rng) {
  std::normal_distribution<double> normal;
  return Quaterniond(normal(rng), normal(rng), normal(rng), normal(rng)).normalized();
}

BodyPose RandomPose(std::mt19937& rng) {
  BodyPose pose;
  for (Quaterniond& q : pose.q_earth_segment) {
    q = RandomQuaternion(rng);
  }
  pose.known.fill(true);
  pose.confidence.fill(1.0F);
  return pose;
}

class ForwardKinematicsTest : public ::testing::Test {
 protected:
  const BodyDefinition body_ = *MakeDefaultBody(BodyId{1});
  const ForwardKinematics kinematics_{body_};
  std::mt19937 rng_{20240517};

  static Quaterniond& Q(BodyPose& pose, Segment segment) {
    return pose.q_earth_segment[Index(segment)];
  }
  static void Know(BodyPose& pose, Segment segment, const Quaterniond& q) {
    pose.known[Index(segment)] = true;
    pose.confidence[Index(segment)] = 1.0F;
    Q(pose, segment) = q;
  }
};

TEST_F(ForwardKinematicsTest, ReferencePoseStandsOnTheFloorWithTheHeadAtBodyHeight) {
  BodyPose pose;
  kinematics_.Place({0.0, 0.0, kStandingRootHeight * kDefaultBodyHeight_m}, pose);
  EXPECT_NEAR(kinematics_.End_m(Segment::kHead, pose).z(), kDefaultBodyHeight_m, 1e-12);
  EXPECT_NEAR(kinematics_.End_m(Segment::kLeftToe, pose).z(), 0.0, 1e-12);
  EXPECT_GT(kinematics_.End_m(Segment::kLeftToe, pose).x(), 0.1) << "toes point to +x";
  EXPECT_GT(pose.p_earth_segment_m[Index(Segment::kLeftHand)].y(), 0.1) << "left is +y";
}

TEST_F(ForwardKinematicsTest, DistancesOfNeighbouringJointsDoNotDependOnThePose) {
  for (int trial = 0; trial < 100; ++trial) {
    BodyPose pose = RandomPose(rng_);
    kinematics_.Place({1.0, -2.0, 3.0}, pose);
    for (const SegmentDefinition& definition : body_.segments) {
      const std::size_t i = Index(definition.segment);
      if (const auto parent = ParentOf(definition.segment)) {
        EXPECT_NEAR((pose.p_earth_segment_m[i] - pose.p_earth_segment_m[Index(*parent)]).norm(),
                    definition.p_parent_segment_m.norm(), 1e-12);
      }
      EXPECT_NEAR((kinematics_.End_m(definition.segment, pose) - pose.p_earth_segment_m[i]).norm(),
                  definition.p_segment_end_m.norm(), 1e-12);
    }
  }
}

TEST_F(ForwardKinematicsTest, TurningAllSegmentsTurnsAllPositionsAboutTheRoot) {
  for (int trial = 0; trial < 100; ++trial) {
    const Vector3d root_m(0.3, -0.2, 0.9);
    BodyPose pose = RandomPose(rng_);
    const Quaterniond turn = RandomQuaternion(rng_);
    BodyPose turned = pose;
    for (Quaterniond& q : turned.q_earth_segment) {
      q = turn * q;
    }
    kinematics_.Place(root_m, pose);
    kinematics_.Place(root_m, turned);
    for (std::size_t i = 0; i < kSegmentCount; ++i) {
      EXPECT_LT(
          (turned.p_earth_segment_m[i] - (root_m + turn * (pose.p_earth_segment_m[i] - root_m)))
              .norm(),
          1e-12);
    }
  }
}

TEST_F(ForwardKinematicsTest, QAndMinusQGiveTheSamePerson) {
  for (int trial = 0; trial < 50; ++trial) {
    BodyPose pose;
    for (const Segment segment : {Segment::kPelvis, Segment::kT8, Segment::kHead,
                                  Segment::kLeftUpperArm, Segment::kLeftForeArm}) {
      Know(pose, segment, math::ExpSO3(0.7 * Vector3d::Random()));
    }
    BodyPose negated = pose;
    for (const Segment segment : {Segment::kT8, Segment::kLeftForeArm}) {
      Quaterniond& q = Q(negated, segment);
      q = Quaterniond(-q.w(), -q.x(), -q.y(), -q.z());
    }
    for (BodyPose* one : {&pose, &negated}) {
      kinematics_.Fill(*one);
      kinematics_.LimitJoints(0.1, *one);
      kinematics_.Place(Vector3d::Zero(), *one);
    }
    for (std::size_t i = 0; i < kSegmentCount; ++i) {
      EXPECT_LT((pose.p_earth_segment_m[i] - negated.p_earth_segment_m[i]).norm(), 1e-9) << i;
    }
  }
}

TEST_F(ForwardKinematicsTest, TheSpineSharesTheTurnBetweenPelvisAndChest) {
  BodyPose pose;
  const Quaterniond pelvis = RandomQuaternion(rng_);
  const Vector3d turn_rad(0.1, 0.8, -0.3);
  Know(pose, Segment::kPelvis, pelvis);
  Know(pose, Segment::kT8, pelvis * math::ExpSO3(turn_rad));
  kinematics_.Fill(pose);
  const auto expect_share = [&](Segment segment, double share) {
    EXPECT_LT(
        math::AngleBetween_rad(Q(pose, segment), pelvis * math::ExpSO3(Vector3d(share * turn_rad))),
        1e-7);
  };
  expect_share(Segment::kL5, 0.25);
  expect_share(Segment::kL3, 0.5);
  expect_share(Segment::kT12, 0.75);
  EXPECT_FLOAT_EQ(pose.confidence[Index(Segment::kL3)], ForwardKinematics::kFillConfidence);
}

TEST_F(ForwardKinematicsTest, TheNeckIsHalfWayAndTheRestFollowsItsParent) {
  BodyPose pose;
  Know(pose, Segment::kPelvis, Quaterniond::Identity());
  Know(pose, Segment::kT8, math::ExpSO3({0.0, 0.2, 0.0}));
  Know(pose, Segment::kHead, math::ExpSO3({0.0, 0.6, 0.0}));
  Know(pose, Segment::kLeftUpperArm, math::ExpSO3({0.9, 0.0, 0.0}));
  kinematics_.Fill(pose);
  const auto angle = [&](Segment a, const Quaterniond& q) {
    return math::AngleBetween_rad(Q(pose, a), q);
  };
  EXPECT_LT(angle(Segment::kNeck, math::ExpSO3({0.0, 0.4, 0.0})), 1e-7);
  EXPECT_LT(angle(Segment::kRightShoulder, Q(pose, Segment::kT8)), 1e-12);
  EXPECT_LT(angle(Segment::kRightHand, Q(pose, Segment::kT8)), 1e-12);
  EXPECT_LT(angle(Segment::kLeftHand, Q(pose, Segment::kLeftUpperArm)), 1e-12);
  EXPECT_LT(angle(Segment::kRightToe, Q(pose, Segment::kPelvis)), 1e-12);
  // Each step away from a measured segment is less sure.
  EXPECT_LT(pose.confidence[Index(Segment::kLeftHand)],
            pose.confidence[Index(Segment::kLeftForeArm)]);
}

TEST_F(ForwardKinematicsTest, WithoutAPelvisTheBodyStandsUprightInTheHeadingOfItsChest) {
  BodyPose pose;
  Know(pose, Segment::kT8, HeadingRotation(1.0) * math::ExpSO3({0.0, 0.5, 0.0}));
  kinematics_.Fill(pose);
  EXPECT_LT(math::AngleBetween_rad(Q(pose, Segment::kPelvis), HeadingRotation(1.0)), 1e-7);
  EXPECT_FLOAT_EQ(pose.confidence[Index(Segment::kPelvis)], 0.0F);
}

TEST_F(ForwardKinematicsTest, WithNothingKnownThePelvisStaysAndAllFollow) {
  BodyPose pose;
  Q(pose, Segment::kPelvis) = HeadingRotation(-0.4);
  kinematics_.Fill(pose);
  for (const Segment segment : AllSegments()) {
    EXPECT_LT(math::AngleBetween_rad(Q(pose, segment), HeadingRotation(-0.4)), 1e-7);
    EXPECT_FLOAT_EQ(pose.confidence[Index(segment)], 0.0F);
  }
}

TEST_F(ForwardKinematicsTest, KnownSegmentsAreNotTouchedByFilling) {
  BodyPose pose = RandomPose(rng_);
  const BodyPose before = pose;
  kinematics_.Fill(pose);
  for (std::size_t i = 0; i < kSegmentCount; ++i) {
    EXPECT_TRUE(pose.q_earth_segment[i].coeffs() == before.q_earth_segment[i].coeffs());
  }
}

TEST_F(ForwardKinematicsTest, AJointWithinItsLimitsIsLeftAloneBitForBit) {
  BodyPose pose;
  Q(pose, Segment::kLeftLowerLeg) = math::ExpSO3({0.0, 1.2, 0.0});
  const Quaterniond before = Q(pose, Segment::kLeftLowerLeg);
  kinematics_.LimitJoints(0.1, pose);
  EXPECT_TRUE(Q(pose, Segment::kLeftLowerLeg).coeffs() == before.coeffs());
}

TEST_F(ForwardKinematicsTest, AKneeBentTheWrongWayComesBackToWithinTheSoftness) {
  const double low_rad = body_.segments[Index(Segment::kLeftLowerLeg)].joint_min_rad.y();
  double last_rad = low_rad;
  for (const double bend_rad : {-0.15, -0.3, -0.6, -1.2}) {
    BodyPose pose;
    const Quaterniond thigh = math::ExpSO3({0.1, -0.4, 0.2});
    Q(pose, Segment::kLeftUpperLeg) = thigh;
    Q(pose, Segment::kLeftLowerLeg) = thigh * math::ExpSO3({0.0, bend_rad, 0.0});
    kinematics_.LimitJoints(0.1, pose);
    const double limited_rad =
        math::LogSO3(thigh.conjugate() * Q(pose, Segment::kLeftLowerLeg)).y();
    EXPECT_LT(limited_rad, last_rad) << "still monotonic";
    EXPECT_GT(limited_rad, low_rad - 0.1 - 1e-9);
    EXPECT_GE(limited_rad, bend_rad);
    last_rad = limited_rad;
  }
}

TEST_F(ForwardKinematicsTest, AFootTurnedTooFarComesBackAndTheShankStays) {
  BodyPose pose;
  const Quaterniond shank = math::ExpSO3({0.1, 0.4, 0.2});
  Q(pose, Segment::kLeftLowerLeg) = shank;
  Q(pose, Segment::kLeftFoot) = shank * RotationOf(Joint::kLeftAnkle, {1.5, 0.1, 0.0});
  kinematics_.LimitJoints(0.1, pose);
  const Vector3d angle_rad =
      AnglesOf(Joint::kLeftAnkle, shank, Q(pose, Segment::kLeftFoot)).angle_rad;
  const double limit_rad = LimitsOf(Joint::kLeftAnkle)->max_rad.x();
  EXPECT_GT(angle_rad.x(), limit_rad);
  EXPECT_LT(angle_rad.x(), limit_rad + 0.1);
  EXPECT_NEAR(angle_rad.y(), 0.1, 1e-9);
  EXPECT_TRUE(Q(pose, Segment::kLeftLowerLeg).coeffs() == shank.coeffs());
}

TEST_F(ForwardKinematicsTest, AShoulderWithoutSensorRisesWithItsArm) {
  for (const auto& [arm, shoulder, joint] :
       {std::tuple{Segment::kLeftUpperArm, Segment::kLeftShoulder, Joint::kLeftShoulder},
        std::tuple{Segment::kRightUpperArm, Segment::kRightShoulder, Joint::kRightShoulder}}) {
    double last_m = -1.0;
    for (const double elevation_rad : {0.0, 0.3, 0.6, 1.2, 2.4}) {
      BodyPose pose;
      const Quaterniond chest = RandomQuaternion(rng_);
      Know(pose, Segment::kPelvis, chest);
      Know(pose, Segment::kT8, chest);
      Know(pose, arm, chest * RotationOf(joint, {0.4, elevation_rad, 0.0}));
      kinematics_.Fill(pose);
      kinematics_.Place(Vector3d::Zero(), pose);
      const double beyond_rad = std::max(0.0, elevation_rad - std::numbers::pi / 6.0);
      EXPECT_NEAR(math::AngleBetween_rad(Q(pose, shoulder), chest), 0.12 * beyond_rad, 1e-6);
      const Vector3d end_m = chest.conjugate() * (kinematics_.End_m(shoulder, pose) -
                                                  pose.p_earth_segment_m[Index(shoulder)]);
      EXPECT_GE(end_m.z(), beyond_rad == 0.0 ? -1e-9 : last_m + 1e-3) << "up, on both sides";
      EXPECT_FLOAT_EQ(pose.confidence[Index(shoulder)], ForwardKinematics::kFillConfidence);
      last_m = end_m.z();
    }
  }
}

TEST_F(ForwardKinematicsTest, AReducedBodyGivesTheSameJointsAsTheFullOne) {
  const ForwardKinematics reduced(KeepSegments(body_, ReducedSegments()));
  EXPECT_EQ(reduced.segments().size(), 15U);
  BodyPose full_pose;
  BodyPose reduced_pose;
  const Quaterniond all = RandomQuaternion(rng_);  // a stiff body: left-out joints do not bend
  for (const Segment segment : reduced.segments()) {
    Know(full_pose, segment, all);
    Know(reduced_pose, segment, all);
  }
  kinematics_.Fill(full_pose);
  kinematics_.Place(Vector3d::Zero(), full_pose);
  reduced.Fill(reduced_pose);
  reduced.Place(Vector3d::Zero(), reduced_pose);
  for (const Segment segment : reduced.segments()) {
    EXPECT_LT((full_pose.p_earth_segment_m[Index(segment)] -
               reduced_pose.p_earth_segment_m[Index(segment)])
                  .norm(),
              1e-9)
        << ToString(segment);
  }
}

}  // namespace
}  // namespace limbcast::body
