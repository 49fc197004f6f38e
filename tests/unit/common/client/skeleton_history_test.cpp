#include "common/client/skeleton_history.hpp"

#include <gtest/gtest.h>

#include "common/body/default_body.hpp"
#include "common/math/rotation.hpp"

namespace limbcast::client {
namespace {

using body::Segment;
using Eigen::Quaterniond;
using Eigen::Vector3d;
using namespace std::chrono_literals;

constexpr Time kStart = TimeFromNanoseconds(1'700'000'000'000'000'000);
constexpr Duration kBound = 50ms;

class SkeletonHistoryTest : public ::testing::Test {
 protected:
  /// A body that walks along x at 1 m/s while its left arm swings about y at 2 rad/s.
  body::Skeleton At(Duration since_start, std::uint32_t revision = 1) const {
    const double t_s = ToSeconds(since_start);
    body::BodyPose pose;
    for (const Segment segment : {Segment::kLeftUpperArm, Segment::kLeftForeArm}) {
      pose.q_earth_segment[body::Index(segment)] = math::ExpSO3({0.0, 2.0 * t_s, 0.0});
    }
    kinematics_.Place({t_s, 0.0, 1.0}, pose);
    body::Skeleton skeleton;
    skeleton.measured_at = kStart + since_start;
    skeleton.definition_revision = revision;
    for (const Segment segment : body::AllSegments()) {
      const std::size_t i = body::Index(segment);
      skeleton.segments.push_back({.segment = segment,
                                   .status = body::SegmentStatus::kTracked,
                                   .confidence = 0.9F,
                                   .q_earth_segment = pose.q_earth_segment[i].cast<float>(),
                                   .p_earth_segment_m = pose.p_earth_segment_m[i].cast<float>()});
    }
    return skeleton;
  }
  static void ExpectNear(const Pose& pose, const body::Skeleton& truth, double limit) {
    ASSERT_EQ(pose.segments.size(), truth.segments.size());
    for (std::size_t i = 0; i < truth.segments.size(); ++i) {
      EXPECT_LT((pose.segments[i].p_earth_segment_m - truth.segments[i].p_earth_segment_m).norm(),
                limit);
      EXPECT_LT(math::AngleBetween_rad(pose.segments[i].q_earth_segment.cast<double>(),
                                       truth.segments[i].q_earth_segment.cast<double>()),
                limit);
    }
  }

  const body::ForwardKinematics kinematics_{*body::MakeDefaultBody(BodyId{1})};
  SkeletonHistory history_{8};
};

TEST_F(SkeletonHistoryTest, IsEmptyAtFirst) {
  EXPECT_TRUE(history_.empty());
  EXPECT_FALSE(history_.At(kStart, kBound, nullptr).has_value());
}

TEST_F(SkeletonHistoryTest, InterpolatesBetweenTwoSkeletons) {
  for (const Duration t : {0ms, 10ms, 20ms, 30ms}) {
    history_.Add(At(t));
  }
  for (const Duration t : {1ms, 10ms, 13ms, 29ms}) {
    const auto pose = history_.At(kStart + t, kBound, &kinematics_);
    ASSERT_TRUE(pose.has_value());
    EXPECT_EQ(pose->source, PoseSource::kInterpolated);
    EXPECT_EQ(pose->at, kStart + t);
    EXPECT_LE(pose->age, 0ns);
    ExpectNear(*pose, At(t), 1e-6);
  }
}

TEST_F(SkeletonHistoryTest, PredictsWithTheLastRatesUpToTheBound) {
  for (int i = 0; i < 20; ++i) {
    history_.Add(At(i * 10ms));
  }
  const auto pose = history_.At(kStart + 190ms + 30ms, kBound, &kinematics_);
  EXPECT_EQ(pose->source, PoseSource::kPredicted);
  EXPECT_EQ(pose->age, 30ms);
  ExpectNear(*pose, At(220ms), 1e-5);

  const auto far = history_.At(kStart + 190ms + 1s, kBound, &kinematics_);
  EXPECT_EQ(far->at, kStart + 190ms + kBound);
  EXPECT_EQ(far->age, 1s);
  ExpectNear(*far, At(190ms + kBound), 1e-5);

  const auto held = history_.At(kStart + 190ms + 30ms, Duration::zero(), &kinematics_);
  EXPECT_EQ(held->source, PoseSource::kHeld);
  ExpectNear(*held, At(190ms), 1e-7);
}

TEST_F(SkeletonHistoryTest, LimbsKeepTheirLengthInBigSteps) {
  history_.Add(At(0ms));
  history_.Add(At(1s));  // the arm turned by 2 rad: a line between the wrists cuts the corner
  const auto length = [](const Pose& pose) {
    return (pose.segments[body::Index(Segment::kLeftHand)].p_earth_segment_m -
            pose.segments[body::Index(Segment::kLeftForeArm)].p_earth_segment_m)
        .norm();
  };
  const float fore_arm_m = 0.146F * 1.75F;
  EXPECT_NEAR(length(*history_.At(kStart + 500ms, kBound, &kinematics_)), fore_arm_m, 1e-5F);
  EXPECT_LT(length(*history_.At(kStart + 500ms, kBound, nullptr)), 0.9F * fore_arm_m)
      << "shows why kinematics are used";
}

TEST_F(SkeletonHistoryTest, OneSkeletonIsHeld) {
  history_.Add(At(0ms));
  const auto pose = history_.At(kStart + 20ms, kBound, &kinematics_);
  EXPECT_EQ(pose->source, PoseSource::kHeld);
  EXPECT_EQ(pose->age, 20ms);
  EXPECT_EQ(history_.At(kStart, kBound, nullptr)->age, 0ns);
}

TEST_F(SkeletonHistoryTest, BeforeTheOldestThatIsKeptThatOneIsGiven) {
  for (int i = 0; i < 20; ++i) {  // 8 are kept: 120 to 190 ms
    history_.Add(At(i * 10ms));
  }
  const auto pose = history_.At(kStart + 50ms, kBound, nullptr);
  EXPECT_EQ(pose->source, PoseSource::kHeld);
  EXPECT_EQ(pose->measured_at, kStart + 120ms);
  EXPECT_EQ(pose->age, -70ms);
}

TEST_F(SkeletonHistoryTest, AChangeOfTheDefinitionIsNotBlended) {
  history_.Add(At(0ms, 1));
  history_.Add(At(10ms, 2));
  EXPECT_EQ(history_.At(kStart + 5ms, kBound, nullptr)->source, PoseSource::kHeld);
  EXPECT_EQ(history_.At(kStart + 15ms, kBound, nullptr)->source, PoseSource::kHeld);
  EXPECT_EQ(history_.At(kStart + 15ms, kBound, nullptr)->definition_revision, 2U);
}

TEST_F(SkeletonHistoryTest, TimeThatGoesBackwardsStartsAnew) {
  history_.Add(At(100ms));
  history_.Add(At(0ms));
  EXPECT_EQ(history_.latest().measured_at, kStart);
  EXPECT_EQ(history_.At(kStart + 50ms, kBound, nullptr)->source, PoseSource::kHeld);
}

TEST_F(SkeletonHistoryTest, SignsOfQuaternionsDoNotMatter) {
  history_.Add(At(0ms));
  body::Skeleton flipped = At(10ms);
  for (body::SegmentPose& segment : flipped.segments) {
    segment.q_earth_segment.coeffs() *= -1.0F;
  }
  history_.Add(flipped);
  ExpectNear(*history_.At(kStart + 5ms, kBound, &kinematics_), At(5ms), 1e-6);
}

}  // namespace
}  // namespace limbcast::client
