#include "common/body/alignment.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <random>
#include <vector>

#include "common/math/rotation.hpp"

namespace limbcast::body {
namespace {

using Eigen::Quaterniond;
using Eigen::Vector3d;

Quaterniond RandomQuaternion(std::mt19937& rng) {
  std::normal_distribution<double> normal;
  return Quaterniond(normal(rng), normal(rng), normal(rng), normal(rng)).normalized();
}

TEST(AlignmentTest, AfterTheReferencePoseTheSegmentFollowsEveryMovementHoweverTheSensorIsMounted) {
  std::mt19937 rng(20240517);
  for (int trial = 0; trial < 200; ++trial) {
    const Quaterniond q_sensor_segment = RandomQuaternion(rng);  // how it is strapped on
    const double facing_rad = std::uniform_real_distribution<double>(-3.1, 3.1)(rng);
    const Quaterniond q_reference = HeadingRotation(facing_rad);

    SensorAlignment alignment;
    alignment.SetFromReferencePose(q_reference * q_sensor_segment.conjugate(), q_reference);

    const Quaterniond q_truth = RandomQuaternion(rng);
    const Quaterniond q_earth_sensor = q_truth * q_sensor_segment.conjugate();
    EXPECT_LT(math::AngleBetween_rad(alignment.Apply(q_earth_sensor), q_truth), 1e-7);
  }
}

TEST(AlignmentTest, AWrongFacingTurnsTheAxisThatThePersonBendsAbout) {
  // Eq. (34) is only as good as the direction the body is said to face: documents the limit.
  const Quaterniond q_reference = HeadingRotation(std::numbers::pi / 2.0);  // really faces north
  SensorAlignment alignment;
  alignment.SetFromReferencePose(q_reference, Quaterniond::Identity());  // said to face east
  const Quaterniond bow = q_reference * math::ExpSO3({0.0, 0.5, 0.0});
  EXPECT_NEAR(std::abs(math::LogSO3(alignment.Apply(bow)).x()), 0.5, 1e-9);
}

TEST(AlignmentTest, SignOfTheQuaternionDoesNotMatter) {
  std::mt19937 rng(7);
  for (int trial = 0; trial < 50; ++trial) {
    const Quaterniond q = RandomQuaternion(rng);
    const Quaterniond minus_q(-q.w(), -q.x(), -q.y(), -q.z());
    SensorAlignment a;
    SensorAlignment b;
    a.SetFromReferencePose(q, Quaterniond::Identity());
    b.SetFromReferencePose(minus_q, Quaterniond::Identity());
    EXPECT_LT(math::AngleBetween_rad(a.q_sensor_segment(), b.q_sensor_segment()), 1e-7);
    EXPECT_LT(math::AngleBetween_rad(a.Apply(q), b.Apply(minus_q)), 1e-7);
  }
}

TEST(AlignmentTest, TurningTheHeadingTurnsTheSegmentAboutEarthZOnly) {
  std::mt19937 rng(11);
  for (int trial = 0; trial < 50; ++trial) {
    SensorAlignment alignment(RandomQuaternion(rng), 0.3);
    const Quaterniond q_earth_sensor = RandomQuaternion(rng);
    const Quaterniond before = alignment.Apply(q_earth_sensor);
    alignment.TurnHeading(1.1);
    EXPECT_LT(
        math::AngleBetween_rad(alignment.Apply(q_earth_sensor), HeadingRotation(1.1) * before),
        1e-7);
  }
}

TEST(AlignmentTest, HeadingCorrectionStaysWithinHalfATurn) {
  SensorAlignment alignment(Quaterniond::Identity(), 3.0);
  alignment.TurnHeading(1.0);
  EXPECT_NEAR(alignment.heading_correction_rad(), 4.0 - 2.0 * std::numbers::pi, 1e-12);
}

TEST(AlignmentTest, ANewReferencePoseKeepsTheHeadingCorrection) {
  SensorAlignment alignment(Quaterniond::Identity(), 0.7);
  const Quaterniond q_earth_sensor = math::ExpSO3({0.2, -0.4, 1.0});
  alignment.SetFromReferencePose(q_earth_sensor, HeadingRotation(0.5));
  EXPECT_DOUBLE_EQ(alignment.heading_correction_rad(), 0.7);
  EXPECT_NEAR(math::Heading_rad(alignment.Apply(q_earth_sensor)), 0.5, 1e-9);
}

TEST(AlignmentTest, InTheTPoseTheArmsPointSidewaysAndThePalmsDown) {
  const Vector3d hanging(0.0, 0.0, -1.0);
  for (const Segment segment :
       {Segment::kRightUpperArm, Segment::kRightForeArm, Segment::kRightHand}) {
    const Quaterniond q = ReferenceOrientation(ReferencePose::kTPose, segment);
    EXPECT_LT((q * hanging - Vector3d(0.0, -1.0, 0.0)).norm(), 1e-12);
    EXPECT_LT((q * Vector3d(0.0, 1.0, 0.0) - Vector3d(0.0, 0.0, -1.0)).norm(), 1e-12) << "palm";
  }
  EXPECT_LT((ReferenceOrientation(ReferencePose::kTPose, Segment::kLeftForeArm) * hanging -
             Vector3d(0.0, 1.0, 0.0))
                .norm(),
            1e-12);
  EXPECT_LT(math::AngleBetween_rad(ReferenceOrientation(ReferencePose::kTPose, Segment::kLeftFoot),
                                   Quaterniond::Identity()),
            1e-12);
  for (const Segment segment : AllSegments()) {
    EXPECT_LT(math::AngleBetween_rad(ReferenceOrientation(ReferencePose::kNPose, segment),
                                     Quaterniond::Identity()),
              1e-12);
  }
}

TEST(AlignmentTest, PosesHaveNames) {
  EXPECT_EQ(ParseReferencePose("n_pose"), ReferencePose::kNPose);
  EXPECT_EQ(ParseReferencePose("t_pose"), ReferencePose::kTPose);
  EXPECT_FALSE(ParseReferencePose("a_pose").has_value());
}

TEST(AverageTest, NothingHasNoAverage) { EXPECT_EQ(Average({}).count, 0U); }

TEST(AverageTest, IsTheMiddleOfASymmetricCloudWhateverTheSigns) {
  std::mt19937 rng(3);
  const Quaterniond middle = RandomQuaternion(rng);
  std::vector<Quaterniond> cloud;
  for (const Vector3d axis : {Vector3d::UnitX(), Vector3d::UnitY(), Vector3d::UnitZ()}) {
    for (const double angle_rad : {-0.05, 0.05}) {
      const Quaterniond q = middle * math::ExpSO3(Vector3d(angle_rad * axis));
      cloud.push_back(cloud.size() % 2 == 0 ? q : Quaterniond(-q.w(), -q.x(), -q.y(), -q.z()));
    }
  }
  const OrientationAverage average = Average(cloud);
  EXPECT_EQ(average.count, 6U);
  EXPECT_LT(math::AngleBetween_rad(average.mean, middle), 1e-7);
  EXPECT_NEAR(average.spread_rad, 0.05, 1e-9);
}

TEST(AverageTest, NoiseAveragesOut) {
  std::mt19937 rng(5);
  std::normal_distribution<double> noise(0.0, 0.01);
  std::vector<Quaterniond> window;
  for (int i = 0; i < 400; ++i) {
    window.push_back(math::ExpSO3({0.4 + noise(rng), noise(rng), noise(rng)}));
  }
  // 0.01 rad on each of three axes over √400: 0.0009 rad expected, 4 sigma allowed.
  EXPECT_LT(math::AngleBetween_rad(Average(window).mean, math::ExpSO3({0.4, 0.0, 0.0})), 0.0036);
}

}  // namespace
}  // namespace limbcast::body
