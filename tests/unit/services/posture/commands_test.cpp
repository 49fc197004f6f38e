#include "services/posture/commands.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>
#include <random>

#include "common/body/alignment.hpp"
#include "common/body/default_body.hpp"
#include "common/math/rotation.hpp"
#include "tests/unit/services/posture/posture_rig.hpp"

namespace limbcast::posture {
namespace {

using body::Segment;
using Eigen::Quaterniond;
using roster::CommandKind;
using ::testing::HasSubstr;
using ::testing::StartsWith;
using namespace std::chrono_literals;

constexpr BodyId kBody{1};
const std::vector<Segment> kSensors = {Segment::kPelvis,      Segment::kT8,
                                       Segment::kHead,        Segment::kLeftUpperArm,
                                       Segment::kLeftForeArm, Segment::kLeftHand};

/// A person with sensors turned arbitrarily on the segments.
class BodyCommandsTest : public ::testing::Test {
 protected:
  BodyCommandsTest() {
    std::mt19937 rng(20240517);
    std::normal_distribution<double> normal;
    for (Quaterniond& q : q_segment_sensor_) {
      q = Quaterniond(normal(rng), normal(rng), normal(rng), normal(rng)).normalized();
    }
    rig_.Roster(MakeRoster(kBody, kSensors));
  }

  /// `seconds` in which segment `bent` is turned by `bend` (in the body's axes), all others stand.
  void Stand(double seconds, double facing_rad, std::optional<Segment> bent = std::nullopt,
             const Quaterniond& bend = Quaterniond::Identity()) {
    for (int i = 0; i < static_cast<int>(seconds * 100.0 + 0.5); ++i) {
      rig_.Advance(10ms);
      for (const Segment segment : kSensors) {
        const Quaterniond q_earth_segment =
            body::HeadingRotation(facing_rad) * (segment == bent ? bend : Quaterniond::Identity());
        rig_.Send(MakeState(kBody, segment, rig_.clock.Now(),
                            q_earth_segment * q_segment_sensor_[body::Index(segment)]));
      }
    }
  }
  double Error_rad(Segment segment, const Quaterniond& expected) {
    return math::AngleBetween_rad(rig_.Last(segment).q_earth_segment.cast<double>(), expected);
  }

  PostureRig rig_;
  body::PerSegment<Quaterniond> q_segment_sensor_;
};

TEST_F(BodyCommandsTest, AfterTheReferencePoseSegmentsFollowHoweverTheSensorsAreMounted) {
  const double facing_rad = 0.8;
  Stand(0.5, facing_rad);
  const auto reply = rig_.Command(kBody, CommandKind::kReferencePose, "", {facing_rad});
  EXPECT_TRUE(reply.accepted) << reply.message;
  EXPECT_THAT(reply.message, HasSubstr("aligned 6 segments, n_pose, facing 45.8 deg"));
  EXPECT_TRUE(rig_.definitions.back().segments[0].aligned);

  const Quaterniond bend = math::ExpSO3({0.0, -1.2, 0.0});  // the elbow
  Stand(0.1, facing_rad, Segment::kLeftForeArm, bend);
  EXPECT_LT(Error_rad(Segment::kLeftForeArm, body::HeadingRotation(facing_rad) * bend), 1e-6);
  EXPECT_LT(Error_rad(Segment::kT8, body::HeadingRotation(facing_rad)), 1e-6);
  EXPECT_LT(Error_rad(Segment::kL3, body::HeadingRotation(facing_rad)), 1e-6) << "filled";
}

TEST_F(BodyCommandsTest, ASecondPoseWithoutFacingKeepsTheWayThePersonFaces) {
  Stand(0.5, 0.8);
  ASSERT_TRUE(rig_.Command(kBody, CommandKind::kReferencePose, "", {0.8}).accepted);
  Stand(0.5, -1.0);
  ASSERT_TRUE(rig_.Command(kBody, CommandKind::kReferencePose).accepted);
  Stand(0.1, -1.0);
  EXPECT_LT(Error_rad(Segment::kHead, body::HeadingRotation(-1.0)), 1e-6);
}

TEST_F(BodyCommandsTest, InTheTPoseTheArmsAreTakenAsHorizontal) {
  Stand(0.5, 0.0);
  ASSERT_TRUE(rig_.Command(kBody, CommandKind::kReferencePose, "t_pose").accepted);
  Stand(0.1, 0.0);
  EXPECT_LT(Error_rad(Segment::kLeftForeArm, math::ExpSO3({std::numbers::pi / 2.0, 0.0, 0.0})),
            1e-6);
  EXPECT_LT(Error_rad(Segment::kPelvis, Quaterniond::Identity()), 1e-6);
}

TEST_F(BodyCommandsTest, ARepeatedPoseIsRefusedWithTheNamesOfThoseWhoHaveNotStarted) {
  for (int i = 0; i < 50; ++i) {
    rig_.Advance(10ms);
    rig_.Tick(kBody,
              {Segment::kPelvis, Segment::kT8, Segment::kLeftUpperArm, Segment::kLeftForeArm});
  }
  const auto reply = rig_.Command(kBody, CommandKind::kReferencePose);
  EXPECT_FALSE(reply.accepted);
  EXPECT_EQ(reply.message, "not started: head, left_hand");
  EXPECT_FALSE(rig_.definitions.back().segments[0].aligned) << "all or none";
}

TEST_F(BodyCommandsTest, APersonWhoMovesIsRefusedWithTheNameAndTheLimit) {
  for (int i = 0; i < 50; ++i) {
    Stand(0.01, 0.0, Segment::kLeftHand, math::ExpSO3({0.0, 0.02 * i, 0.0}));
  }
  const auto reply = rig_.Command(kBody, CommandKind::kReferencePose);
  EXPECT_FALSE(reply.accepted);
  EXPECT_THAT(reply.message, StartsWith("moving more than 3.4 deg within 0.3 s: left_hand ("));
}

TEST_F(BodyCommandsTest, RightAfterTheStartThereIsTooLittleToAverage) {
  Stand(0.05, 0.0);
  const auto reply = rig_.Command(kBody, CommandKind::kReferencePose);
  EXPECT_FALSE(reply.accepted);
  EXPECT_THAT(reply.message, HasSubstr("less than 0.15 s of samples: pelvis, t8, head"));
}

TEST_F(BodyCommandsTest, TheReferencePoseIsTheMeanOfTheWindow) {
  std::mt19937 rng(3);
  std::normal_distribution<double> noise(0.0, 0.01);
  for (int i = 0; i < 60; ++i) {
    Stand(0.01, 0.0, Segment::kT8, math::ExpSO3({noise(rng), noise(rng), noise(rng)}));
  }
  ASSERT_TRUE(rig_.Command(kBody, CommandKind::kReferencePose).accepted);
  Stand(0.1, 0.0);
  // One sample alone would be off by 0.017 rad in the mean; 15 or more of them by 0.0045.
  EXPECT_LT(Error_rad(Segment::kT8, Quaterniond::Identity()), 0.01);
}

TEST_F(BodyCommandsTest, BadPosesAndFacingsAreRefusedWithTheLimit) {
  Stand(0.5, 0.0);
  EXPECT_EQ(rig_.Command(kBody, CommandKind::kReferencePose, "a_pose").message,
            "pose must be n_pose or t_pose, is \"a_pose\"");
  EXPECT_THAT(rig_.Command(kBody, CommandKind::kReferencePose, "", {90.0}).message,
              HasSubstr("facing must be one number in [-6.283, 6.283] rad"));
  EXPECT_FALSE(rig_.Command(kBody, CommandKind::kReferencePose, "",
                            {std::numeric_limits<double>::quiet_NaN()})
                   .accepted);
}

TEST_F(BodyCommandsTest, ResetHeadingTurnsTheWholeBodySoThatThePelvisFacesX) {
  Stand(0.5, 0.8);
  ASSERT_TRUE(rig_.Command(kBody, CommandKind::kReferencePose, "", {0.8}).accepted);
  const Quaterniond bend = math::ExpSO3({0.0, -0.5, 0.0});
  Stand(0.1, 1.3, Segment::kLeftForeArm, bend);
  ASSERT_TRUE(rig_.Command(kBody, CommandKind::kResetHeading).accepted);
  Stand(0.5, 1.3, Segment::kLeftForeArm, bend);  // the transition takes blend_s
  EXPECT_LT(Error_rad(Segment::kPelvis, Quaterniond::Identity()), 1e-6);
  EXPECT_LT(Error_rad(Segment::kLeftForeArm, bend), 1e-6) << "the posture itself is unchanged";
  EXPECT_NEAR(rig_.definitions.back().segments[0].heading_correction_rad, -1.3, 1e-6);
}

TEST_F(BodyCommandsTest, ResetHeadingOfEachSegmentBringsDriftedHeadingsTogether) {
  Stand(0.5, 0.0);
  ASSERT_TRUE(rig_.Command(kBody, CommandKind::kReferencePose).accepted);
  const Quaterniond drift = body::HeadingRotation(0.3);  // of one sensor without magnetometer
  Stand(0.1, 0.0, Segment::kHead, drift);
  EXPECT_NEAR(Error_rad(Segment::kHead, Quaterniond::Identity()), 0.3, 1e-6);
  ASSERT_TRUE(rig_.Command(kBody, CommandKind::kResetHeading, "segments", {0.5}).accepted);
  Stand(0.5, 0.0, Segment::kHead, drift);
  EXPECT_LT(Error_rad(Segment::kHead, body::HeadingRotation(0.5)), 1e-6);
  EXPECT_LT(Error_rad(Segment::kPelvis, body::HeadingRotation(0.5)), 1e-6);
  EXPECT_FALSE(rig_.Command(kBody, CommandKind::kResetHeading, "everything").accepted);
}

TEST_F(BodyCommandsTest, ANewAlignmentComesIntoForceWithoutAJump) {
  Stand(0.5, 0.0);
  ASSERT_TRUE(rig_.Command(kBody, CommandKind::kReferencePose).accepted);
  Stand(0.1, 0.0);
  ASSERT_TRUE(rig_.Command(kBody, CommandKind::kResetHeading, "", {1.0}).accepted);
  double last_rad = 0.0;
  double fastest_rad = 0.0;
  for (int tick = 0; tick < 50; ++tick) {
    Stand(0.01, 0.0);
    const double now_rad = Error_rad(Segment::kPelvis, Quaterniond::Identity());
    fastest_rad = std::max(fastest_rad, std::abs(now_rad - last_rad));
    last_rad = now_rad;
  }
  EXPECT_NEAR(last_rad, 1.0, 1e-6);
  // The steepest slope of 3u² − 2u³ is 1.5: 1 rad in 0.4 s turns by 0.0375 rad in 10 ms at most.
  EXPECT_LT(fastest_rad, 0.038);
}

TEST_F(BodyCommandsTest, MountingResetMendsOneSlippedStrapAndLeavesTheRest) {
  Stand(0.5, 0.8);
  ASSERT_TRUE(rig_.Command(kBody, CommandKind::kReferencePose, "", {0.8}).accepted);
  const Quaterniond slipped = math::ExpSO3({0.3, 0.2, -0.4});
  Stand(0.5, 0.8, Segment::kLeftForeArm, slipped);
  const auto head = rig_.definitions.back().segments[6].q_sensor_segment;
  const auto reply = rig_.Command(kBody, CommandKind::kResetMounting, "left_fore_arm");
  ASSERT_TRUE(reply.accepted) << reply.message;
  Stand(0.5, 0.8, Segment::kLeftForeArm, slipped);
  EXPECT_LT(Error_rad(Segment::kLeftForeArm, body::HeadingRotation(0.8)), 1e-6);
  EXPECT_EQ(rig_.definitions.back().segments[6].q_sensor_segment.coeffs(), head.coeffs());

  EXPECT_EQ(rig_.Command(kBody, CommandKind::kResetMounting, "left_foot").message,
            "no sensor on a segment \"left_foot\"");
}

TEST_F(BodyCommandsTest, AFunctionalCalibrationNeedsAReferencePoseAndAWalk) {
  Stand(0.5, 0.0);
  EXPECT_EQ(rig_.Command(kBody, CommandKind::kFunctionalCalibration, "start").message,
            "take a reference pose first");
  ASSERT_TRUE(rig_.Command(kBody, CommandKind::kReferencePose).accepted);
  const auto before = rig_.definitions.size();
  EXPECT_TRUE(rig_.Command(kBody, CommandKind::kFunctionalCalibration, "start").accepted);
  EXPECT_EQ(rig_.definitions.size(), before) << "nothing has changed yet";
  Stand(1.0, 0.0);
  EXPECT_THAT(rig_.Command(kBody, CommandKind::kFunctionalCalibration, "finish").message,
              HasSubstr("needs at least 6 s: go on"));
  Stand(8.0, 0.0);
  EXPECT_THAT(rig_.Command(kBody, CommandKind::kFunctionalCalibration, "finish").message,
              HasSubstr("no steady walking"));
  EXPECT_EQ(rig_.Command(kBody, CommandKind::kFunctionalCalibration, "finish").message,
            "no functional calibration was started");
  EXPECT_EQ(rig_.Command(kBody, CommandKind::kFunctionalCalibration, "now").message,
            "calibration must be start, finish or cancel, is \"now\"");
}

TEST_F(BodyCommandsTest, ResetHeadingNeedsAPelvis) {
  EXPECT_EQ(rig_.Command(kBody, CommandKind::kResetHeading).message, "not started: pelvis");
}

TEST_F(BodyCommandsTest, DimensionsChangeLengthsAndRefuseNonsense) {
  Stand(0.1, 0.0);
  const auto reply = rig_.Command(kBody, CommandKind::kSetDimensions, "height", {2.0});
  EXPECT_TRUE(reply.accepted);
  EXPECT_EQ(reply.message, "height is 2.000 m");
  Stand(0.01, 0.0);
  EXPECT_NEAR((rig_.Last(Segment::kLeftForeArm).p_earth_segment_m -
               rig_.Last(Segment::kLeftHand).p_earth_segment_m)
                  .norm(),
              2.0 * 0.146, 1e-5);
  EXPECT_THAT(rig_.Command(kBody, CommandKind::kSetDimensions, "height", {20.0}).message,
              HasSubstr("height must be in [0.5, 2.5] m, is 20"));
  EXPECT_THAT(rig_.Command(kBody, CommandKind::kSetDimensions, "wing", {1.0}).message,
              HasSubstr("\"wing\""));
  EXPECT_THAT(rig_.Command(kBody, CommandKind::kSetDimensions, "height").message,
              HasSubstr("needs 1 number"));
}

TEST_F(BodyCommandsTest, UndoTakesBackOneCommandAfterTheOther) {
  Stand(0.5, 0.0);
  const body::BodyDefinition first = rig_.definitions.back();
  ASSERT_TRUE(rig_.Command(kBody, CommandKind::kReferencePose).accepted);
  const body::BodyDefinition second = rig_.definitions.back();
  ASSERT_TRUE(rig_.Command(kBody, CommandKind::kSetDimensions, "height", {2.0}).accepted);

  ASSERT_TRUE(rig_.Command(kBody, CommandKind::kUndo).accepted);
  EXPECT_TRUE(rig_.definitions.back().segments[0].aligned);
  EXPECT_TRUE(rig_.definitions.back().segments[0].p_segment_end_m.isApprox(
      second.segments[0].p_segment_end_m));
  EXPECT_GT(rig_.definitions.back().revision, second.revision) << "a revision never returns";
  ASSERT_TRUE(rig_.Command(kBody, CommandKind::kUndo).accepted);
  EXPECT_FALSE(rig_.definitions.back().segments[0].aligned);
  EXPECT_TRUE(rig_.definitions.back().segments[0].q_sensor_segment.isApprox(
      first.segments[0].q_sensor_segment));
  EXPECT_EQ(rig_.Command(kBody, CommandKind::kUndo).message, "nothing to undo");
}

TEST_F(BodyCommandsTest, AnUndoneMeasurementIsNoMeasurement) {
  Stand(0.5, 0.0);
  const std::size_t thigh = body::Index(Segment::kRightUpperLeg);
  ASSERT_TRUE(rig_.Command(kBody, CommandKind::kSetDimensions, "right_upper_leg", {0.6}).accepted);
  ASSERT_TRUE(rig_.Command(kBody, CommandKind::kUndo).accepted);
  ASSERT_TRUE(rig_.Command(kBody, CommandKind::kSetDimensions, "height", {1.9}).accepted);
  EXPECT_TRUE(rig_.definitions.back().segments[thigh].p_segment_end_m.isApprox(
      body::MakeDefaultBody(kBody, 1.9)->segments[thigh].p_segment_end_m, 1e-6));
}

TEST_F(BodyCommandsTest, ASensorThatIsReplacedLosesItsAlignmentAndUndoDoesNotRestoreIt) {
  Stand(0.5, 0.0);
  ASSERT_TRUE(rig_.Command(kBody, CommandKind::kReferencePose).accepted);
  ASSERT_TRUE(rig_.Command(kBody, CommandKind::kSetDimensions, "height", {1.8}).accepted);
  roster::RosterEntry entry = MakeRoster(kBody, kSensors);
  entry.sensors[0].sensor_uid = SensorUid{424242};
  rig_.Roster(entry);
  EXPECT_FALSE(rig_.definitions.back().segments[0].aligned);
  EXPECT_TRUE(rig_.definitions.back().segments[body::Index(Segment::kT8)].aligned);
  ASSERT_TRUE(rig_.Command(kBody, CommandKind::kUndo).accepted);
  EXPECT_FALSE(rig_.definitions.back().segments[0].aligned);
}

TEST_F(BodyCommandsTest, AnUnknownBodyIsRefusedAndCommandsOfOthersAreNotAnswered) {
  EXPECT_EQ(rig_.Command(BodyId{9}, CommandKind::kUndo).message, "no body 9 in the roster");
  rig_.replies.clear();
  roster::Command command;
  command.body_id = kBody;
  command.kind = CommandKind::kSelectFilter;
  ASSERT_TRUE(rig_.commands->Write(command).ok());
  EXPECT_TRUE(rig_.replies.empty());
}

}  // namespace
}  // namespace limbcast::posture
