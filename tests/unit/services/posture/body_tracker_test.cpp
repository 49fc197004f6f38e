#include "services/posture/body_tracker.hpp"

#include <gtest/gtest.h>

#include <vector>

#include "common/body/default_body.hpp"
#include "common/math/rotation.hpp"
#include "tests/unit/services/posture/posture_rig.hpp"

namespace limbcast::posture {
namespace {

using body::Segment;
using namespace std::chrono_literals;

constexpr BodyId kBody{1};
constexpr Time kStart = TimeFromNanoseconds(1'700'000'000'000'000'000);

// What a body does as part of the service is in posture_service_test.cpp; here: what is not seen
// from outside.
class BodyTrackerTest : public ::testing::Test {
 protected:
  BodyTrackerTest() { tracker_.SetRoster(MakeRoster(kBody, {Segment::kPelvis, Segment::kHead})); }
  StateFate Send(Segment segment, Time at,
                 const Eigen::Quaterniond& q = Eigen::Quaterniond::Identity()) {
    return tracker_.OnState(MakeStateInput(MakeState(kBody, segment, at, q), at), at);
  }

  PostureConfig config_;
  std::vector<TickEnd> ends_;
  std::vector<body::Skeleton> skeletons_;
  BodyTracker tracker_{config_, *body::MakeDefaultBody(kBody),
                       [this](const body::Skeleton& skeleton, TickEnd end, bool) {
                         ends_.push_back(end);
                         skeletons_.push_back(skeleton);
                       }};
};

TEST_F(BodyTrackerTest, SaysWhatBecameOfEveryState) {
  EXPECT_EQ(Send(Segment::kPelvis, kStart), StateFate::kUsed);
  EXPECT_EQ(Send(Segment::kPelvis, kStart), StateFate::kIgnored);
  EXPECT_EQ(Send(Segment::kLeftToe, kStart), StateFate::kUnassigned);
  EXPECT_EQ(tracker_.due(), kStart + 8ms);
  tracker_.OnDue(kStart + 7ms);
  EXPECT_TRUE(ends_.empty());
  tracker_.OnDue(kStart + 8ms);
  EXPECT_EQ(ends_, std::vector{TickEnd::kDeadline});
  EXPECT_FALSE(tracker_.due().has_value());
  EXPECT_EQ(Send(Segment::kHead, kStart), StateFate::kLate);
  EXPECT_EQ(Send(Segment::kHead, Time{}), StateFate::kIgnored);
}

TEST_F(BodyTrackerTest, ALateStateStillIsTheNewestThatIsKnownOfItsSegment) {
  (void)Send(Segment::kPelvis, kStart);
  tracker_.OnDue(kStart + 8ms);
  (void)Send(Segment::kHead, kStart, math::ExpSO3({0.0, 0.4, 0.0}));
  (void)Send(Segment::kPelvis, kStart + 10ms);
  tracker_.OnDue(kStart + 18ms);
  ASSERT_EQ(skeletons_.size(), 2U);
  const body::SegmentPose& head = skeletons_[1].segments[body::Index(Segment::kHead)];
  EXPECT_EQ(head.status, body::SegmentStatus::kStale);
  EXPECT_LT(
      math::AngleBetween_rad(head.q_earth_segment.cast<double>(), math::ExpSO3({0.0, 0.4, 0.0})),
      1e-6);
}

TEST_F(BodyTrackerTest, PublishedQuaternionsHaveWNotNegative) {
  const Eigen::Quaterniond q = math::ExpSO3({0.0, 2.0, 0.0});
  (void)Send(Segment::kPelvis, kStart, Eigen::Quaterniond(-q.w(), -q.x(), -q.y(), -q.z()));
  (void)Send(Segment::kHead, kStart, q);
  ASSERT_EQ(skeletons_.size(), 1U);
  for (const body::SegmentPose& segment : skeletons_[0].segments) {
    EXPECT_GE(segment.q_earth_segment.w(), 0.0F);
    EXPECT_NEAR(segment.q_earth_segment.norm(), 1.0F, 1e-6F);
  }
}

TEST_F(BodyTrackerTest, TheDefinitionIsChangedOnceForEachChange) {
  EXPECT_TRUE(tracker_.TakeDefinitionChanged());
  EXPECT_FALSE(tracker_.TakeDefinitionChanged());
  EXPECT_FALSE(tracker_.SetRoster(MakeRoster(kBody, {Segment::kPelvis, Segment::kHead})));
  EXPECT_FALSE(tracker_.TakeDefinitionChanged());
  const std::uint32_t revision = tracker_.definition().revision;
  body::BodyDefinition changed = tracker_.definition();
  changed.revision = 0;
  tracker_.Redefine(changed, kStart);
  EXPECT_TRUE(tracker_.TakeDefinitionChanged());
  EXPECT_EQ(tracker_.definition().revision, revision + 1);
  EXPECT_EQ(tracker_.definition().changed_at, kStart);
}

TEST_F(BodyTrackerTest, JointLimitsAreAppliedWhenAskedFor) {
  config_.joint_limits = true;
  tracker_.SetRoster(
      MakeRoster(kBody, {Segment::kPelvis, Segment::kLeftUpperLeg, Segment::kLeftLowerLeg}));
  (void)Send(Segment::kPelvis, kStart);
  (void)Send(Segment::kLeftUpperLeg, kStart);
  (void)Send(Segment::kLeftLowerLeg, kStart, math::ExpSO3({0.0, -0.8, 0.0}));
  ASSERT_EQ(skeletons_.size(), 1U);
  const auto& knee = skeletons_[0].segments[body::Index(Segment::kLeftLowerLeg)];
  EXPECT_LT(
      math::AngleBetween_rad(knee.q_earth_segment.cast<double>(), Eigen::Quaterniond::Identity()),
      0.1 + config_.joint_softness_rad + 1e-6);
}

}  // namespace
}  // namespace limbcast::posture
