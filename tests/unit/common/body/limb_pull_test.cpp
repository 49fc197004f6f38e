#include "common/body/limb_pull.hpp"

#include <gtest/gtest.h>

#include <limits>

#include "common/body/default_body.hpp"
#include "common/math/rotation.hpp"

namespace limbcast::body {
namespace {

const BodyDefinition& Person() {
  static const BodyDefinition body = *MakeDefaultBody(BodyId{1});
  return body;
}

// All measured; arms and legs bent, so that no lever is along another.
BodyPose TruePose() {
  BodyPose pose;
  pose.known.fill(true);
  pose.q_earth_segment[Index(Segment::kRightUpperArm)] = math::ExpSO3({0.2, -0.5, 0.1});
  pose.q_earth_segment[Index(Segment::kRightForeArm)] = math::ExpSO3({0.1, -1.4, 0.3});
  pose.q_earth_segment[Index(Segment::kRightUpperLeg)] = math::ExpSO3({0.0, -0.4, 0.0});
  pose.q_earth_segment[Index(Segment::kRightLowerLeg)] = math::ExpSO3({0.0, 0.3, 0.1});
  ForwardKinematics(Person()).Place(Eigen::Vector3d::Zero(), pose);
  return pose;
}

LimbPosition PositionIn(const BodyPose& pose, Segment segment, double sigma_m) {
  LimbPosition position;
  position.segment = segment;
  position.p_segment_sensor_m = {0.01, -0.05, -0.15};
  position.p_from_sensor_m = {-0.12, 0.0, 0.05};
  position.p_sensor_sensor_m = pose.p_earth_segment_m[Index(segment)] +
                               pose.q_earth_segment[Index(segment)] * position.p_segment_sensor_m -
                               pose.p_earth_segment_m[0] -
                               pose.q_earth_segment[0] * position.p_from_sensor_m;
  position.cov_m2 = sigma_m * sigma_m * Eigen::Matrix3d::Identity();
  return position;
}

double Off_m(const BodyPose& pose, Segment segment) {
  return (pose.p_earth_segment_m[Index(segment)] - TruePose().p_earth_segment_m[Index(segment)])
      .norm();
}

// How far the sensor on `segment` is from where it truly is, against the one on the pelvis.
double SensorOff_m(const BodyPose& pose, Segment segment) {
  const LimbPosition is = PositionIn(pose, segment, 1.0);
  return (is.p_sensor_sensor_m - PositionIn(TruePose(), segment, 1.0).p_sensor_sensor_m).norm();
}

// The upper segment of the limb is measured `error_rad` wrong; the position is the true one.
BodyPose Pulled(Segment upper, Segment lower, double error_rad, double sigma_m, bool* done,
                const LimbPullConfig& config = {}) {
  const BodyPose truth = TruePose();
  BodyPose pose = truth;
  pose.q_earth_segment[Index(upper)] =
      math::ExpSO3({0.0, error_rad, 0.0}) * pose.q_earth_segment[Index(upper)];
  const ForwardKinematics kinematics(Person());
  kinematics.Place(Eigen::Vector3d::Zero(), pose);
  *done = PullLimb(config, PositionIn(truth, lower, sigma_m), {}, pose);
  kinematics.Place(Eigen::Vector3d::Zero(), pose);
  return pose;
}

class LimbPullTest : public ::testing::TestWithParam<std::array<Segment, 3>> {};

TEST_P(LimbPullTest, ACertainPositionBringsTheEndOfTheLimbBack) {
  const auto [upper, lower, end] = GetParam();
  bool done = false;
  const LimbPullConfig exact{.sigma_trunk_m = 1e-4};
  const BodyPose before = Pulled(upper, lower, 0.08, 1e3, &done, exact);
  const BodyPose after = Pulled(upper, lower, 0.08, 1e-4, &done, exact);
  EXPECT_TRUE(done);
  EXPECT_GT(SensorOff_m(before, lower), 0.02);
  EXPECT_LT(SensorOff_m(after, lower), 0.05 * SensorOff_m(before, lower));
  // Both segments turned, though only one of them was wrong: the end is nearer, not there.
  EXPECT_LT(Off_m(after, end), 0.75 * Off_m(before, end));
}

TEST_P(LimbPullTest, AnUncertainPositionLeavesTheLimbAsItIs) {
  const auto [upper, lower, end] = GetParam();
  bool done = false;
  const double free_m = Off_m(Pulled(upper, lower, 0.08, 1e3, &done), end);
  EXPECT_NEAR(Off_m(Pulled(upper, lower, 0.08, 0.5, &done), end), free_m, 0.02 * free_m);
}

TEST_P(LimbPullTest, APositionThatAgreesChangesNothing) {
  const auto [upper, lower, end] = GetParam();
  bool done = false;
  EXPECT_LT(Off_m(Pulled(upper, lower, 0.0, 1e-3, &done), end), 1e-9);
}

INSTANTIATE_TEST_SUITE_P(Limbs, LimbPullTest,
                         ::testing::Values(std::array{Segment::kRightUpperArm,
                                                      Segment::kRightForeArm, Segment::kRightHand},
                                           std::array{Segment::kRightUpperLeg,
                                                      Segment::kRightLowerLeg,
                                                      Segment::kRightFoot}));

TEST(LimbPullRefusalTest, NonsenseAndWhatIsNotMeasuredAreRefused) {
  const BodyPose truth = TruePose();
  const LimbPosition good = PositionIn(truth, Segment::kRightForeArm, 0.01);
  const auto refused = [&](const LimbPosition& position, const BodyPose& start) {
    BodyPose pose = start;
    const bool done = PullLimb({}, position, {}, pose);
    const std::size_t i = Index(Segment::kRightForeArm);
    return !done && pose.q_earth_segment[i].coeffs() == start.q_earth_segment[i].coeffs();
  };
  EXPECT_FALSE(refused(good, truth));
  LimbPosition far = good;
  far.p_sensor_sensor_m.x() += 1.0;
  EXPECT_TRUE(refused(far, truth));
  far.p_sensor_sensor_m.x() = std::numeric_limits<double>::quiet_NaN();
  EXPECT_TRUE(refused(far, truth));
  LimbPosition trunk = good;
  trunk.segment = Segment::kT8;
  EXPECT_TRUE(refused(trunk, truth));
  BodyPose unmeasured = truth;
  unmeasured.known[Index(Segment::kRightUpperArm)] = false;
  EXPECT_TRUE(refused(good, unmeasured));
}

TEST(LimbPullSharingTest, TheLessCertainOrientationTurnsMore) {
  const BodyPose truth = TruePose();
  LimbPosition position = PositionIn(truth, Segment::kRightForeArm, 1e-3);
  position.p_sensor_sensor_m += Eigen::Vector3d(0.01, 0.01, 0.0);
  PerSegment<float> sigma_rad{};
  sigma_rad[Index(Segment::kRightForeArm)] = 0.3F;
  BodyPose pose = truth;
  ASSERT_TRUE(PullLimb({}, position, sigma_rad, pose));
  const auto turned = [&](Segment segment) {
    return math::AngleBetween_rad(pose.q_earth_segment[Index(segment)],
                                  truth.q_earth_segment[Index(segment)]);
  };
  EXPECT_GT(turned(Segment::kRightForeArm), 3.0 * turned(Segment::kRightUpperArm));
}

}  // namespace
}  // namespace limbcast::body
