#include "common/body/heading_tracker.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "common/body/alignment.hpp"
#include "tests/support/walking_person.hpp"

namespace limbcast::body {
namespace {

using test_support::WalkingPerson;

constexpr double kDt_s = 0.02;

/// A walker whose segments each have a heading error; the tracker turns them.
class HeadingTrackerTest : public ::testing::Test {
 protected:
  HeadingTrackerTest() {
    for (const Segment segment : WalkingPerson::Sixteen()) {
      use_[Index(segment)] = true;
    }
  }
  void Run(double from_s, double to_s, const PerSegment<double>& drift_rad_s = {}) {
    PerSegment<Eigen::Quaterniond> q{};
    for (double t_s = from_s; t_s < to_s; t_s += kDt_s) {
      // The same 20 s of walking again and again.
      const double walk_s = t_s < 3.0 ? t_s : 6.0 + std::fmod(t_s, 21.6);
      for (const Segment segment : WalkingPerson::Sixteen()) {
        const std::size_t i = Index(segment);
        error_rad_[i] += drift_rad_s[i] * kDt_s;
        q[i] = HeadingRotation(error_rad_[i]) * person_.Truth(segment, walk_s);
      }
      const PerSegment<double>& turn_rad = tracker_.Update(kDt_s, use_, q);
      for (std::size_t i = 0; i < kSegmentCount; ++i) {
        fastest_rad_s_ = std::max(fastest_rad_s_, std::abs(turn_rad[i]) / kDt_s);
        error_rad_[i] += turn_rad[i];
      }
    }
  }

  WalkingPerson person_;
  HeadingTracker tracker_;
  PerSegment<bool> use_{};
  PerSegment<double> error_rad_{};
  double fastest_rad_s_ = 0.0;
};

TEST_F(HeadingTrackerTest, AWrongHeadingOfALegFallsAsTheTimeConstantSays) {
  error_rad_[Index(Segment::kLeftUpperLeg)] = 0.3;
  Run(3.0, 18.0);
  EXPECT_TRUE(tracker_.walking());
  EXPECT_NEAR(error_rad_[Index(Segment::kLeftUpperLeg)], 0.3 * std::exp(-1.0), 0.05);
  Run(18.0, 90.0);
  EXPECT_LT(std::abs(error_rad_[Index(Segment::kLeftUpperLeg)]), 0.06);
  EXPECT_LT(fastest_rad_s_, 0.03 + 0.0036);
}

TEST_F(HeadingTrackerTest, AShankFollowsItsThigh) {
  error_rad_[Index(Segment::kRightLowerLeg)] = -0.3;
  Run(3.0, 90.0);
  EXPECT_LT(std::abs(error_rad_[Index(Segment::kRightLowerLeg)] -
                     error_rad_[Index(Segment::kRightUpperLeg)]),
            0.06);
}

TEST_F(HeadingTrackerTest, StandingCorrectsNothing) {
  error_rad_[Index(Segment::kLeftUpperLeg)] = 0.3;
  Run(0.0, 2.9);
  EXPECT_FALSE(tracker_.walking());
  EXPECT_EQ(error_rad_[Index(Segment::kLeftUpperLeg)], 0.3);
}

TEST_F(HeadingTrackerTest, ASteadyDriftIsLearnedAndThenTakenBackWithoutAnError) {
  PerSegment<double> drift_rad_s{};
  const std::size_t foot = Index(Segment::kLeftFoot);
  drift_rad_s[foot] = 0.002;  // 7° a minute
  Run(3.0, 60.0, drift_rad_s);
  const double early_rad = error_rad_[foot];
  EXPECT_NEAR(early_rad, 0.002 * 15.0, 0.03) << "proportional part alone: rate times time constant";
  Run(60.0, 1500.0, drift_rad_s);
  EXPECT_LT(std::abs(error_rad_[foot] - early_rad + 0.002 * 15.0), 0.012);
}

TEST_F(HeadingTrackerTest, ArmsMoveOnlyByWhatWasObserved) {
  const std::size_t hand = Index(Segment::kLeftHand);
  error_rad_[hand] = 0.4;
  Run(3.0, 30.0);
  EXPECT_EQ(error_rad_[hand], 0.4);
  tracker_.Observe(Segment::kLeftHand, 0.4, 0.05);
  Run(30.0, 90.0);
  EXPECT_NEAR(error_rad_[hand], 0.4 * (1.0 - 1.0 / 1.25), 0.03);
}

TEST_F(HeadingTrackerTest, SegmentsThatAreNotInUseAreLeftAlone) {
  use_[Index(Segment::kLeftUpperLeg)] = false;
  error_rad_[Index(Segment::kLeftUpperLeg)] = 0.3;
  Run(3.0, 30.0);
  EXPECT_EQ(error_rad_[Index(Segment::kLeftUpperLeg)], 0.3);
}

}  // namespace
}  // namespace limbcast::body
