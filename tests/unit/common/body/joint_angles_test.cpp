#include "common/body/joint_angles.hpp"

#include <gtest/gtest.h>

#include <numbers>
#include <random>
#include <set>
#include <string>

#include "common/body/alignment.hpp"
#include "common/math/rotation.hpp"

namespace limbcast::body {
namespace {

using Eigen::Quaterniond;
using Eigen::Vector3d;

constexpr double kDeg = std::numbers::pi / 180.0;
constexpr double kPi = std::numbers::pi;
// House axes: about +x the body leans to the right, about +y forward, about +z it turns left.
const Vector3d kForward = Vector3d::UnitX();
const Vector3d kLeft = Vector3d::UnitY();
const Vector3d kUp = Vector3d::UnitZ();

Quaterniond Turn(const Vector3d& axis, double angle_deg) {
  return math::ExpSO3(angle_deg * kDeg * axis);
}

Quaterniond RandomQuaternion(std::mt19937& rng) {
  std::normal_distribution<double> normal;
  return Quaterniond(normal(rng), normal(rng), normal(rng), normal(rng)).normalized();
}

Vector3d Degrees(Joint joint, const Quaterniond& q_parent_child) {
  return AnglesOf(joint, Quaterniond::Identity(), q_parent_child).angle_rad / kDeg;
}

void ExpectDegrees(Joint joint, const Quaterniond& q_parent_child, const Vector3d& expected) {
  const Vector3d is = Degrees(joint, q_parent_child);
  EXPECT_LT((is - expected).norm(), 1e-9) << ToString(joint) << ": " << is.transpose();
}

bool IsLeft(Joint joint) { return joint >= Joint::kLeftHip; }
Joint RightOf(Joint joint) { return IsLeft(joint) ? static_cast<Joint>(Index(joint) - 6) : joint; }

// The mirror image of a rotation in the sagittal plane x–z.
Quaterniond Mirrored(const Quaterniond& q) { return {q.w(), -q.x(), q.y(), -q.z()}; }

class EveryJoint : public ::testing::TestWithParam<int> {
 protected:
  const Joint joint_ = static_cast<Joint>(GetParam());
  std::mt19937 rng_{20240517};
};

TEST_P(EveryJoint, AnglesAreZeroInTheNPose) { ExpectDegrees(joint_, {1, 0, 0, 0}, {0, 0, 0}); }

TEST_P(EveryJoint, AnglesPutTogetherAgainAreTheRotation) {
  for (int trial = 0; trial < 300; ++trial) {
    const Quaterniond q_earth_parent = RandomQuaternion(rng_);
    const Quaterniond q_parent_child = RandomQuaternion(rng_);
    const JointAngles angles = AnglesOf(joint_, q_earth_parent, q_earth_parent * q_parent_child);
    EXPECT_LT(math::AngleBetween_rad(RotationOf(joint_, angles.angle_rad), q_parent_child), 1e-12);
  }
}

TEST_P(EveryJoint, AnglesInTheirRangesComeBack) {
  const bool shoulder = RightOf(joint_) == Joint::kRightShoulder;
  std::uniform_real_distribution<double> full(-179.0, 179.0);
  std::uniform_real_distribution<double> middle(shoulder ? 1.0 : -89.0, shoulder ? 179.0 : 89.0);
  for (int trial = 0; trial < 300; ++trial) {
    const Vector3d given(full(rng_), middle(rng_), full(rng_));
    const Vector3d is = Degrees(joint_, RotationOf(joint_, given * kDeg));
    EXPECT_LT((is - given).norm(), 1e-7) << given.transpose() << " became " << is.transpose();
  }
}

TEST_P(EveryJoint, TurningTheWholePersonChangesNothingButThePelvis) {
  if (joint_ == Joint::kPelvis) {
    return;  // its parent is the earth
  }
  for (int trial = 0; trial < 100; ++trial) {
    const Quaterniond parent = RandomQuaternion(rng_);
    const Quaterniond child = RandomQuaternion(rng_);
    const Quaterniond turn = RandomQuaternion(rng_);
    EXPECT_LT((AnglesOf(joint_, parent, child).angle_rad -
               AnglesOf(joint_, turn * parent, turn * child).angle_rad)
                  .norm(),
              1e-8);
  }
}

TEST_P(EveryJoint, AMirroredPersonHasTheSameAnglesOnTheOtherSide) {
  if (!IsLeft(joint_)) {
    return;
  }
  for (int trial = 0; trial < 100; ++trial) {
    const Quaterniond parent = RandomQuaternion(rng_);
    const Quaterniond child = RandomQuaternion(rng_);
    EXPECT_LT((AnglesOf(joint_, Mirrored(parent), Mirrored(child)).angle_rad -
               AnglesOf(RightOf(joint_), parent, child).angle_rad)
                  .norm(),
              1e-12);
  }
}

TEST_P(EveryJoint, AtAndNextToTheSingularityTheRotationIsStillRight) {
  const bool shoulder = RightOf(joint_) == Joint::kRightShoulder;
  for (const double singular : {shoulder ? 0.0 : kPi / 2.0, shoulder ? kPi : -kPi / 2.0}) {
    const double inwards = singular > (shoulder ? 1.0 : 0.0) ? -1.0 : 1.0;
    for (const double away_rad : {0.0, 1e-12, 0.9e-9, 1.1e-9, 1e-6, 1e-3, 0.17, 0.18}) {
      const Quaterniond q = RotationOf(joint_, {0.3, singular + inwards * away_rad, -0.7});
      const JointAngles angles = AnglesOf(joint_, Quaterniond::Identity(), q);
      EXPECT_TRUE(angles.angle_rad.allFinite());
      // Closer than 1e-9 the joint is taken as singular, which turns it by at most as much.
      EXPECT_LT(math::AngleBetween_rad(RotationOf(joint_, angles.angle_rad), q), 2e-9) << away_rad;
      EXPECT_EQ(angles.near_singular, away_rad < kNearSingular_rad) << away_rad;
      EXPECT_NEAR(angles.angle_rad[1], singular + inwards * away_rad, 1e-12);
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Joints, EveryJoint, ::testing::Range(0, static_cast<int>(kJointCount)),
                         [](const auto& joint) {
                           return std::string(ToString(static_cast<Joint>(joint.param)));
                         });

// By hand: a limb hangs to −z; what turns it forward turns about −y, what turns it to the left
// about −x, and the front to the left about +z.
TEST(JointAnglesTest, HipSignsAreThoseOfTheIsb) {
  ExpectDegrees(Joint::kRightHip, Turn(-kLeft, 90), {90, 0, 0});    // thigh forward
  ExpectDegrees(Joint::kRightHip, Turn(kForward, 10), {0, 10, 0});  // thigh to the left
  ExpectDegrees(Joint::kRightHip, Turn(kUp, 15), {0, 0, 15});       // toes to the left
  ExpectDegrees(Joint::kLeftHip, Turn(-kLeft, 90), {90, 0, 0});
  ExpectDegrees(Joint::kLeftHip, Turn(-kForward, 10), {0, 10, 0});
  ExpectDegrees(Joint::kLeftHip, Turn(-kUp, 15), {0, 0, 15});
}

TEST(JointAnglesTest, TheTurnsOfAHipFollowOneAnother) {
  // First flexion about the pelvis' axis, then adduction about the axis that went along, last
  // rotation about the thigh.
  const Quaterniond q = Turn(-kLeft, 60) * Turn(kForward, 20) * Turn(kUp, 30);
  ExpectDegrees(Joint::kRightHip, q, {60, 20, 30});
}

TEST(JointAnglesTest, KneeFlexionAndDorsiflexionArePositive) {
  ExpectDegrees(Joint::kRightKnee, Turn(kLeft, 60), {60, 0, 0});
  ExpectDegrees(Joint::kLeftKnee, Turn(kLeft, 60), {60, 0, 0});
  ExpectDegrees(Joint::kRightAnkle, Turn(-kLeft, 10), {10, 0, 0});  // toes up
  ExpectDegrees(Joint::kLeftAnkle, Turn(kLeft, 20), {-20, 0, 0});   // toes down
  // The sole to the midline is inversion: the right foot's inner (left) edge up is about +x.
  ExpectDegrees(Joint::kRightAnkle, Turn(kForward, 12), {0, 12, 0});
  ExpectDegrees(Joint::kLeftAnkle, Turn(-kForward, 12), {0, 12, 0});
}

TEST(JointAnglesTest, ShoulderIsZeroSidewaysAndNinetyForward) {
  ExpectDegrees(Joint::kRightShoulder, Turn(-kForward, 80), {0, 80, 0});  // arm to the right
  ExpectDegrees(Joint::kLeftShoulder, Turn(kForward, 80), {0, 80, 0});
  for (const Joint shoulder : {Joint::kRightShoulder, Joint::kLeftShoulder}) {
    // Forward: the elbow's hinge still points sideways, so the arm has turned out by 90°.
    ExpectDegrees(shoulder, Turn(-kLeft, 80), {90, 80, -90});
    ExpectDegrees(shoulder, Turn(kLeft, 30), {-90, 30, 90});  // backwards
  }
  const JointAngles hanging =
      AnglesOf(Joint::kRightShoulder, Quaterniond::Identity(), Turn(kUp, 25));
  EXPECT_TRUE(hanging.near_singular);
  EXPECT_NEAR(hanging.angle_rad.x() + hanging.angle_rad.z(), 25 * kDeg, 1e-12)
      << "of a hanging arm the sum is the internal rotation";
}

TEST(JointAnglesTest, TPoseIsNinetyDegreesOfElevationInTheFrontalPlane) {
  for (const Joint shoulder : {Joint::kRightShoulder, Joint::kLeftShoulder}) {
    const JointSegments segments = SegmentsOf(shoulder);
    const JointAngles angles =
        AnglesOf(shoulder, ReferenceOrientation(ReferencePose::kTPose, *segments.parent),
                 ReferenceOrientation(ReferencePose::kTPose, segments.child));
    EXPECT_LT((angles.angle_rad / kDeg - Vector3d(0, 90, 0)).norm(), 1e-9);
    EXPECT_FALSE(angles.near_singular);
  }
}

TEST(JointAnglesTest, ElbowFlexesForwardAndPronatesThePalmBack) {
  ExpectDegrees(Joint::kRightElbow, Turn(-kLeft, 90), {90, 0, 0});
  ExpectDegrees(Joint::kLeftElbow, Turn(-kLeft, 90), {90, 0, 0});
  ExpectDegrees(Joint::kRightElbow, Turn(-kForward, 10), {0, 10, 0});  // hand away from the body
  ExpectDegrees(Joint::kLeftElbow, Turn(kForward, 10), {0, 10, 0});
  // The right palm looks left (+y); turned by +90° about z it looks back (−x).
  ExpectDegrees(Joint::kRightElbow, Turn(kUp, 70), {0, 0, 70});
  ExpectDegrees(Joint::kLeftElbow, Turn(-kUp, 70), {0, 0, 70});
}

TEST(JointAnglesTest, WristFlexesTowardsThePalm) {
  ExpectDegrees(Joint::kRightWrist, Turn(kForward, 40), {40, 0, 0});  // fingers to the left
  ExpectDegrees(Joint::kLeftWrist, Turn(-kForward, 40), {40, 0, 0});
  for (const Joint wrist : {Joint::kRightWrist, Joint::kLeftWrist}) {
    ExpectDegrees(wrist, Turn(kLeft, 20), {0, 20, 0});  // fingers back, to the little finger's side
  }
  ExpectDegrees(Joint::kRightWrist, Turn(kUp, 5), {0, 0, 5});
}

TEST(JointAnglesTest, TrunkAndNeckFlexForward) {
  for (const Joint joint : {Joint::kTrunk, Joint::kNeck}) {
    ExpectDegrees(joint, Turn(kLeft, 35), {35, 0, 0});
    ExpectDegrees(joint, Turn(kForward, 25), {0, 25, 0});
    ExpectDegrees(joint, Turn(kUp, 45), {0, 0, 45});
  }
}

TEST(JointAnglesTest, TiltAndObliquityOfThePelvisDoNotDependOnWhereItFaces) {
  for (const double heading_deg : {0.0, 37.0, 90.0, -170.0}) {
    ExpectDegrees(Joint::kPelvis, Turn(kUp, heading_deg) * Turn(kForward, 8) * Turn(kLeft, 12),
                  {heading_deg, 8, 12});
  }
}

TEST(JointAnglesTest, AllJointsAreThoseOfTheirSegments) {
  std::mt19937 rng(20240517);
  std::array<Quaterniond, kSegmentCount> pose;
  for (Quaterniond& q : pose) {
    q = RandomQuaternion(rng);
  }
  const auto all = AllJointAngles(pose);
  for (std::size_t i = 0; i < kJointCount; ++i) {
    const auto [parent, child] = SegmentsOf(static_cast<Joint>(i));
    const Quaterniond q_parent = parent ? pose[Index(*parent)] : Quaterniond::Identity();
    EXPECT_EQ(all[i].angle_rad,
              AnglesOf(static_cast<Joint>(i), q_parent, pose[Index(child)]).angle_rad);
  }
}

TEST(JointAnglesTest, NamesGoThereAndBack) {
  std::set<std::string_view> names;
  for (std::size_t i = 0; i < kJointCount; ++i) {
    const auto joint = static_cast<Joint>(i);
    EXPECT_EQ(ParseJoint(ToString(joint)), joint);
    names.insert(ToString(joint));
    for (const std::string_view angle : AngleNames(joint)) {
      EXPECT_FALSE(angle.empty());
    }
  }
  EXPECT_EQ(names.size(), kJointCount);
  EXPECT_EQ(ParseJoint("ellbow"), std::nullopt);
  EXPECT_EQ(ToString(static_cast<Joint>(99)), "unknown");
}

}  // namespace
}  // namespace limbcast::body
