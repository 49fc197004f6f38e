// A simulated person with arbitrarily mounted sensors and perfect filters: what is left is the
// error of alignment, filling and kinematics, against the truth of the simulation.
#include <gtest/gtest.h>

#include <algorithm>

#include "common/body/alignment.hpp"
#include "common/math/rotation.hpp"
#include "common/simulation/person_motion.hpp"
#include "common/simulation/sensor_set.hpp"
#include "tests/unit/services/posture/posture_rig.hpp"

namespace limbcast::posture {
namespace {

using namespace std::chrono_literals;

constexpr BodyId kBody{1};

class PostureWalkerTest : public ::testing::Test {
 protected:
  static constexpr double kFacing_rad = 0.7;

  PostureWalkerTest() {
    const auto set = simulation::SegmentsOf(simulation::SensorSet::kStandard17);
    sensors_.assign(set.begin(), set.end());
    for (const body::Segment segment : sensors_) {
      mountings_[body::Index(segment)] = simulation::MakeMounting(
          segment, motion_.shape(), simulation::MountingStyle::kArbitrary, 20240517);
    }
    rig_.Roster(MakeRoster(kBody, sensors_));
  }

  /// Sends the tick of `t_s` and gives the truth.
  simulation::PersonPose Tick(double t_s) {
    const simulation::PersonPose truth = motion_.At(t_s);
    rig_.Advance(10ms);
    sensing::PositionFix fix;
    fix.body_id = kBody;
    fix.p_earth_body_m = truth.segments[0].p_earth_local_m;
    EXPECT_TRUE(rig_.fixes->Write(fix).ok());
    for (const body::Segment segment : sensors_) {
      rig_.Send(
          MakeState(kBody, segment, rig_.clock.Now(),
                    Truth(truth, segment) * mountings_[body::Index(segment)].q_segment_sensor));
    }
    return truth;
  }
  static Eigen::Quaterniond Truth(const simulation::PersonPose& pose, body::Segment segment) {
    return math::QuaternionFromMatrix(pose.segments[body::Index(segment)].R_earth_local);
  }

  PostureRig rig_;
  std::vector<body::Segment> sensors_;
  body::PerSegment<simulation::SensorMounting> mountings_;
  simulation::PersonMotion motion_ =
      *simulation::PersonMotion::Make(*simulation::MakePersonShape(body::kDefaultBodyHeight_m),
                                      {.start = {.heading_rad = kFacing_rad}});
};

TEST_F(PostureWalkerTest, AfterTheReferencePoseTheWholePersonFollowsTheTruth) {
  double t_s = 0.0;
  for (; t_s < 1.0; t_s += 0.01) {
    (void)Tick(t_s);
  }
  const auto reply = rig_.Command(kBody, roster::CommandKind::kReferencePose, "", {kFacing_rad});
  ASSERT_TRUE(reply.accepted) << reply.message;

  double worst_rad = 0.0;
  double worst_m = 0.0;
  for (; t_s < 30.0; t_s += 0.01) {
    const simulation::PersonPose truth = Tick(t_s);
    for (const body::Segment segment : sensors_) {
      const body::SegmentPose& pose = rig_.Last(segment);
      worst_rad = std::max(worst_rad, math::AngleBetween_rad(pose.q_earth_segment.cast<double>(),
                                                             Truth(truth, segment)));
      worst_m = std::max(worst_m, (pose.p_earth_segment_m.cast<double>() -
                                   truth.segments[body::Index(segment)].p_earth_local_m)
                                      .norm());
    }
  }
  // The simulated stand is the N-pose, and its spine bends by the rule of ForwardKinematics::Fill:
  // nothing but float rounding may be left.
  EXPECT_LT(worst_rad, 1e-3);
  EXPECT_LT(worst_m, 1e-3);
  EXPECT_EQ(rig_.Counted(Count::kSkeletonsComplete), rig_.Counted(Count::kSkeletons));
}

}  // namespace
}  // namespace limbcast::posture
