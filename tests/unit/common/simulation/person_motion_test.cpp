#include "common/simulation/person_motion.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "common/math/rotation.hpp"

namespace limbcast::simulation {
namespace {

using body::Index;
using body::Segment;

constexpr double kDeg = std::numbers::pi / 180.0;
constexpr double kRound_s = 73.0;  // a little more than the default schedule before it repeats

PersonMotion MakePerson(const FloorPose& start = {}) {
  return *PersonMotion::Make(*MakePersonShape(1.75), {.start = start});
}

// Rotation of the child about the parent's y axis: flexion of a hinge, positive as in R_y.
double Flexion_rad(const PersonPose& pose, Segment parent, Segment child) {
  const Eigen::Matrix3d R = pose.segments[Index(parent)].R_earth_local.transpose() *
                            pose.segments[Index(child)].R_earth_local;
  return std::atan2(R(0, 2), R(2, 2));
}

TEST(PersonMotionTest, NPoseIsTheReferencePoseFacingTheStart) {
  const PersonMotion person = MakePerson({3.0, -1.0, 0.7});
  const PersonPose pose = person.At(2.0);
  const Eigen::Matrix3d facing =
      Eigen::AngleAxisd(0.7, Eigen::Vector3d::UnitZ()).toRotationMatrix();
  for (const RigidMotion& segment : pose.segments) {
    EXPECT_LT((segment.R_earth_local - facing).norm(), 1e-12);
    EXPECT_LT(segment.w_earth_local_rad_s.norm(), 1e-12);
    EXPECT_LT(segment.a_earth_local_m_s2.norm(), 1e-12);
  }
  EXPECT_LT((pose.segments[0].p_earth_local_m - Eigen::Vector3d(3.0, -1.0, 0.53 * 1.75)).norm(),
            1e-9);
}

TEST(PersonMotionTest, RatesAndAccelerationsAreThoseOfTheMotion) {
  constexpr double kStep_s = 2e-5;
  const PersonMotion person = MakePerson({1.0, 2.0, -2.5});
  for (double t_s = 0.0033; t_s < kRound_s; t_s += 0.0371) {
    const PersonPose before = person.At(t_s - kStep_s);
    const PersonPose at = person.At(t_s);
    const PersonPose after = person.At(t_s + kStep_s);
    for (std::size_t i = 0; i < body::kSegmentCount; ++i) {
      const RigidMotion& a = before.segments[i];
      const RigidMotion& m = at.segments[i];
      const RigidMotion& b = after.segments[i];
      const auto slope = [](const Eigen::Vector3d& from, const Eigen::Vector3d& to) {
        return Eigen::Vector3d((to - from) / (2.0 * kStep_s));
      };
      const Eigen::Vector3d w_rad_s =
          math::LogSO3(math::QuaternionFromMatrix(b.R_earth_local * a.R_earth_local.transpose())) /
          (2.0 * kStep_s);
      const auto name = body::ToString(static_cast<Segment>(i));
      ASSERT_LT((slope(a.p_earth_local_m, b.p_earth_local_m) - m.v_earth_local_m_s).norm(), 1e-4)
          << name << " at " << t_s;
      ASSERT_LT((slope(a.v_earth_local_m_s, b.v_earth_local_m_s) - m.a_earth_local_m_s2).norm(),
                0.05)
          << name << " at " << t_s;
      ASSERT_LT((w_rad_s - m.w_earth_local_rad_s).norm(), 1e-4) << name << " at " << t_s;
      ASSERT_LT(
          (slope(a.w_earth_local_rad_s, b.w_earth_local_rad_s) - m.wd_earth_local_rad_s2).norm(),
          0.1)
          << name << " at " << t_s;
    }
  }
}

TEST(PersonMotionTest, NothingJumpsWherePhasesMeet) {
  constexpr double kBeside_s = 1e-7;
  const PersonMotion person = MakePerson();
  for (const TimedPhase& phase : person.timeline().phases()) {
    const PersonPose before = person.At(phase.end_s - kBeside_s);
    const PersonPose after = person.At(phase.end_s + kBeside_s);
    for (std::size_t i = 0; i < body::kSegmentCount; ++i) {
      const RigidMotion& a = before.segments[i];
      const RigidMotion& b = after.segments[i];
      const auto name = body::ToString(static_cast<Segment>(i));
      EXPECT_LT((a.p_earth_local_m - b.p_earth_local_m).norm(), 1e-6) << name << phase.end_s;
      EXPECT_LT((a.R_earth_local - b.R_earth_local).norm(), 1e-6) << name << phase.end_s;
      EXPECT_LT((a.w_earth_local_rad_s - b.w_earth_local_rad_s).norm(), 1e-4)
          << name << phase.end_s;
      EXPECT_LT((a.a_earth_local_m_s2 - b.a_earth_local_m_s2).norm(), 1e-2) << name << phase.end_s;
      EXPECT_LT((a.wd_earth_local_rad_s2 - b.wd_earth_local_rad_s2).norm(), 1e-2)
          << name << phase.end_s;
    }
  }
}

TEST(PersonMotionTest, FeetOnTheGroundNeitherSlideNorSink) {
  const PersonMotion person = MakePerson();
  const PersonShape& shape = person.shape();
  const Eigen::Vector3d p_heel_m(-shape.heel_back_m, 0.0, -shape.ankle_height_m);
  double lowest_m = 1.0;
  double slide_m = 0.0;  // of the resting point, summed over the whole round
  constexpr double kStep_s = 0.002;
  for (double t_s = 0.0; t_s < kRound_s; t_s += kStep_s) {
    const PersonPose pose = person.At(t_s);
    for (const Segment foot : {Segment::kRightFoot, Segment::kLeftFoot}) {
      const RigidMotion& foot_motion = pose.segments[Index(foot)];
      const RigidMotion& toe = pose.segments[Index(foot) + 1];
      const RigidMotion heel = AtPoint(foot_motion, p_heel_m);
      const RigidMotion tip = AtPoint(toe, shape.p_segment_end_m[Index(foot) + 1]);
      lowest_m = std::min({lowest_m, heel.p_earth_local_m.z(), tip.p_earth_local_m.z()});
      if ((pose.contacts >> Index(foot) & 1U) != 0U) {
        slide_m += kStep_s * std::min(heel.v_earth_local_m_s.norm(), toe.v_earth_local_m_s.norm());
      }
    }
  }
  EXPECT_GT(lowest_m, -0.015);  // the tip of the toes grazes the ground early in swing
  EXPECT_LT(slide_m, 0.01);
}

TEST(PersonMotionTest, LegsMoveAsInWalkingPeople) {
  const PersonMotion person = MakePerson();
  double swing_peak_rad = 0.0;
  double least_rad = 10.0;
  for (double t_s = 9.0; t_s < 18.0; t_s += 0.005) {
    const PersonPose pose = person.At(t_s);
    for (const Segment upper : {Segment::kRightUpperLeg, Segment::kLeftUpperLeg}) {
      const auto lower = static_cast<Segment>(Index(upper) + 1);
      const auto foot = static_cast<Segment>(Index(upper) + 2);
      const double hip_rad = -Flexion_rad(pose, Segment::kPelvis, upper);
      const double knee_rad = Flexion_rad(pose, upper, lower);
      const double ankle_rad = Flexion_rad(pose, lower, foot);
      swing_peak_rad = std::max(swing_peak_rad, knee_rad);
      least_rad = std::min(least_rad, knee_rad);
      ASSERT_GT(hip_rad, -25.0 * kDeg) << t_s;
      ASSERT_LT(hip_rad, 50.0 * kDeg) << t_s;
      ASSERT_GT(ankle_rad, -35.0 * kDeg) << t_s;  // dorsiflexion
      ASSERT_LT(ankle_rad, 30.0 * kDeg) << t_s;
    }
  }
  EXPECT_GT(swing_peak_rad, 55.0 * kDeg);
  EXPECT_LT(swing_peak_rad, 75.0 * kDeg);
  EXPECT_GT(least_rad, 3.0 * kDeg);
  EXPECT_LT(least_rad, 20.0 * kDeg);
}

TEST(PersonMotionTest, SitsWithBentHipsAndKnees) {
  const PersonMotion person = MakePerson();
  const auto& phases = person.timeline().phases();
  const auto sit = std::find_if(phases.begin(), phases.end(), [](const TimedPhase& phase) {
    return phase.phase.kind == PhaseKind::kSit;
  });
  ASSERT_NE(sit, phases.end());
  const PersonPose pose = person.At(0.5 * (sit->start_s + sit->end_s));
  for (const Segment upper : {Segment::kRightUpperLeg, Segment::kLeftUpperLeg}) {
    const auto lower = static_cast<Segment>(Index(upper) + 1);
    EXPECT_NEAR(Flexion_rad(pose, upper, lower), 90.0 * kDeg, 15.0 * kDeg);
    EXPECT_NEAR(-Flexion_rad(pose, Segment::kPelvis, upper), 80.0 * kDeg, 15.0 * kDeg);
  }
}

TEST(PersonMotionTest, ArmsSeeLargeRotationsAndElbowsStayElbows) {
  const PersonMotion person = MakePerson();
  double highest = -1.0;
  for (double t_s = 0.0; t_s < kRound_s; t_s += 0.01) {
    const PersonPose pose = person.At(t_s);
    for (const Segment upper : {Segment::kRightUpperArm, Segment::kLeftUpperArm}) {
      const auto fore = static_cast<Segment>(Index(upper) + 1);
      const Eigen::Vector3d z_upper = pose.segments[Index(upper)].R_earth_local.col(2);
      const Eigen::Vector3d z_fore = pose.segments[Index(fore)].R_earth_local.col(2);
      highest = std::max(highest, -z_upper.z());
      ASSERT_LT(std::acos(std::clamp(z_upper.dot(z_fore), -1.0, 1.0)), 150.0 * kDeg);
    }
  }
  EXPECT_GT(highest, 0.8);
}

TEST(PersonMotionTest, BonesHangTogetherAtTheJoints) {
  const PersonMotion person = MakePerson();
  for (const double t_s : {2.0, 8.3, 15.1, 26.0, 40.0, 60.0}) {
    const PersonPose pose = person.At(t_s);
    for (const Segment segment : body::AllSegments()) {
      if (const auto parent = body::ParentOf(segment)) {
        const RigidMotion joint = AtPoint(pose.segments[Index(*parent)],
                                          person.shape().p_parent_segment_m[Index(segment)]);
        EXPECT_LT((joint.p_earth_local_m - pose.segments[Index(segment)].p_earth_local_m).norm(),
                  1e-12);
      }
    }
  }
}

TEST(PersonMotionTest, RefusesABadSchedule) {
  EXPECT_FALSE(PersonMotion::Make(*MakePersonShape(1.75), {.schedule = MotionSchedule{}}).ok());
}

}  // namespace
}  // namespace limbcast::simulation
