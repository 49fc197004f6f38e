// Alignment that changes while states pass by: calibration without a command, headings kept.
#include <gtest/gtest.h>

#include "common/math/rotation.hpp"
#include "services/posture/body_tracker.hpp"
#include "tests/support/temporary_folder.hpp"
#include "tests/support/walking_person.hpp"
#include "tests/unit/services/posture/posture_rig.hpp"

namespace limbcast::posture {
namespace {

using body::Segment;
using test_support::WalkingPerson;
using namespace std::chrono_literals;

constexpr BodyId kBody{1};

/// A walker whose sensors have no magnetometer, before a posture service.
class AutomaticCalibrationTest : public ::testing::Test {
 protected:
  PostureConfig Config() const {
    PostureConfig config;
    config.automatic_calibration = true;
    config.state_dir = folder_.path().string();
    return config;
  }

  /// `turned_rad`: the filters began anew, with other headings.
  void Run(PostureRig& rig, double from_s, double to_s, double turned_rad = 0.0) {
    for (double t_s = from_s; t_s < to_s; t_s += 0.02) {
      rig.Advance(20ms);
      for (const Segment segment : segments_) {
        const auto reading = person_.Read(segment, t_s);
        const Eigen::Quaterniond turn =
            body::HeadingRotation(turned_rad * static_cast<double>(1 + body::Index(segment)));
        auto state = MakeState(kBody, segment, rig.clock.Now(), turn * reading.q_earth_sensor);
        state.heading = HeadingReference::kArbitrary;
        state.free_accel_in_earth_m_s2 = (turn * reading.accel_in_earth_m_s2).cast<float>();
        rig.Send(state);
      }
    }
  }
  double WorstError_rad(const PostureRig& rig, double t_s) const {
    double worst_rad = 0.0;
    for (const Segment segment : segments_) {
      worst_rad = std::max(worst_rad,
                           math::AngleBetween_rad(rig.Last(segment).q_earth_segment.cast<double>(),
                                                  person_.Truth(segment, t_s)));
    }
    return worst_rad;
  }

  test_support::TemporaryFolder folder_;
  WalkingPerson person_;
  const std::vector<Segment> segments_ = WalkingPerson::Sixteen();
};

TEST_F(AutomaticCalibrationTest, StandingAndWalkingIsEnoughAndIsKept) {
  {
    PostureRig rig(Config());
    rig.Roster(MakeRoster(kBody, segments_));
    Run(rig, 0.0, 25.0);
    EXPECT_EQ(rig.Counted(Count::kCalibrations), 1U);
    EXPECT_TRUE(rig.definitions.back().segments[0].aligned);
    EXPECT_LT(WorstError_rad(rig, 24.98), 0.15);
  }
  // The next day: filters with other headings; the person only has to stand.
  PostureRig rig(Config());
  rig.Roster(MakeRoster(kBody, segments_));
  EXPECT_TRUE(rig.definitions.back().segments[0].aligned);
  Run(rig, 0.0, 2.9, 0.4);
  EXPECT_EQ(rig.Counted(Count::kCalibrations), 1U);
  EXPECT_LT(WorstError_rad(rig, 2.88), 0.12);
}

TEST_F(AutomaticCalibrationTest, SwitchedOffNothingIsAligned) {
  PostureConfig config = Config();
  config.automatic_calibration = false;
  PostureRig rig(config);
  rig.Roster(MakeRoster(kBody, segments_));
  Run(rig, 0.0, 25.0);
  EXPECT_EQ(rig.Counted(Count::kCalibrations), 0U);
  EXPECT_FALSE(rig.definitions.back().segments[0].aligned);
}

TEST_F(AutomaticCalibrationTest, HeadingsThatDriftedAreDrawnTogetherAndClientsSeeIt) {
  PostureRig rig(Config());
  rig.Roster(MakeRoster(kBody, segments_));
  Run(rig, 0.0, 20.0);
  ASSERT_EQ(rig.Counted(Count::kCalibrations), 1U);
  const auto definitions = rig.definitions.size();
  // One thigh's heading jumps by 17°.
  rig.Command(kBody, roster::CommandKind::kResetHeading, "body");
  const auto Drift = [&](double from_s, double to_s) {
    for (double t_s = from_s; t_s < to_s; t_s += 0.02) {
      rig.Advance(20ms);
      for (const Segment segment : segments_) {
        const auto reading = person_.Read(segment, t_s);
        const Eigen::Quaterniond turn =
            body::HeadingRotation(segment == Segment::kLeftUpperLeg ? 0.3 : 0.0);
        auto state = MakeState(kBody, segment, rig.clock.Now(), turn * reading.q_earth_sensor);
        state.heading = HeadingReference::kArbitrary;
        rig.Send(state);
      }
    }
  };
  const auto Apart_rad = [&] {
    const auto left = rig.Last(Segment::kLeftUpperLeg).q_earth_segment.cast<double>();
    const auto right = rig.Last(Segment::kRightUpperLeg).q_earth_segment.cast<double>();
    return std::abs(
        std::remainder(math::Heading_rad(left) - math::Heading_rad(right), 2.0 * std::numbers::pi));
  };
  Drift(20.0, 20.5);
  EXPECT_GT(Apart_rad(), 0.15);
  for (int again = 0; again < 4; ++again) {
    Drift(10.0, 30.8);  // 19 strides and a bit, to the same phase
  }
  EXPECT_LT(Apart_rad(), 0.12);
  EXPECT_GT(rig.definitions.size(), definitions + 2);
}

}  // namespace
}  // namespace limbcast::posture
