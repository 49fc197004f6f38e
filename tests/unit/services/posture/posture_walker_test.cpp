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
  simulation::PersonPose Tick(double t_s, bool with_fix = true) {
    const simulation::PersonPose truth = motion_.At(t_s);
    rig_.Advance(10ms);
    if (with_fix) {
      sensing::PositionFix fix;
      fix.body_id = kBody;
      fix.p_earth_body_m = truth.segments[0].p_earth_local_m;
      EXPECT_TRUE(rig_.fixes->Write(fix).ok());
    }
    for (const body::Segment segment : sensors_) {
      const simulation::SensorMounting& mounting = mountings_[body::Index(segment)];
      const simulation::RigidMotion sensor =
          simulation::AtPoint(truth.segments[body::Index(segment)], mounting.p_segment_sensor_m);
      const Eigen::Quaterniond q_earth_sensor = Truth(truth, segment) * mounting.q_segment_sensor;
      body::SegmentState state = MakeState(kBody, segment, rig_.clock.Now(), q_earth_sensor);
      state.w_earth_sensor_in_sensor_rad_s =
          (q_earth_sensor.conjugate() * sensor.w_earth_local_rad_s).cast<float>();
      state.free_accel_in_earth_m_s2 = sensor.a_earth_local_m_s2.cast<float>();
      rig_.Send(state);
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

TEST_F(PostureWalkerTest, WithoutAnyFixThePersonWalksByItsFeet) {
  double t_s = 0.0;
  for (; t_s < 1.0; t_s += 0.01) {
    (void)Tick(t_s, false);
    EXPECT_EQ(rig_.skeletons.back().contacts, 0U) << "sensors that are not aligned say nothing";
  }
  ASSERT_TRUE(rig_.Command(kBody, roster::CommandKind::kReferencePose, "", {kFacing_rad}).accepted);

  Eigen::Vector3d offset_m = Eigen::Vector3d::Zero();
  double worst_m = 0.0;
  bool seen_single = false;
  for (; t_s < 60.0; t_s += 0.01) {
    const simulation::PersonPose truth = Tick(t_s, false);
    const Eigen::Vector3d off_m =
        rig_.Last(body::Segment::kPelvis).p_earth_segment_m.cast<double>() -
        truth.segments[0].p_earth_local_m;
    if (offset_m.isZero()) {
      offset_m = off_m;  // where it began is not known without a fix
    }
    worst_m = std::max(worst_m, (off_m - offset_m).norm());
    const std::uint32_t feet =
        rig_.skeletons.back().contacts & (1U << body::Index(body::Segment::kRightFoot) |
                                          1U << body::Index(body::Segment::kLeftFoot));
    EXPECT_NE(feet, 0U) << "t = " << t_s;
    seen_single = seen_single || (feet & (feet - 1)) == 0;
  }
  EXPECT_TRUE(seen_single);
  EXPECT_NEAR(offset_m.z(), 0.0, 1e-3);
  EXPECT_LT(worst_m, 0.05) << "of some 30 m walked, turned and sat down";
}

TEST_F(PostureWalkerTest, WithContactsOffTheRootStands) {
  PostureConfig config;
  config.contacts = false;
  PostureRig rig(config);
  rig.Roster(MakeRoster(kBody, sensors_));
  rig.Run(kBody, sensors_, 0.5);
  ASSERT_TRUE(rig.Command(kBody, roster::CommandKind::kReferencePose, "", {0.0}).accepted);
  const Eigen::Vector3f before_m = rig.Last(body::Segment::kPelvis).p_earth_segment_m;
  rig.Run(kBody, sensors_, 0.5, math::ExpSO3({0.0, 0.5, 0.0}));
  EXPECT_EQ(rig.Last(body::Segment::kPelvis).p_earth_segment_m, before_m);
  EXPECT_EQ(rig.skeletons.back().contacts, 0U);
}

}  // namespace
}  // namespace limbcast::posture
