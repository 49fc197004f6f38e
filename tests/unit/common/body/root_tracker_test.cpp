#include "common/body/root_tracker.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <iostream>
#include <limits>
#include <numbers>
#include <utility>

#include "common/body/default_body.hpp"
#include "common/math/rotation.hpp"
#include "common/simulation/person_motion.hpp"
#include "common/simulation/random.hpp"
#include "tests/support/walking_slip.hpp"

namespace limbcast::body {
namespace {

using Eigen::Matrix3d;
using Eigen::Quaterniond;
using Eigen::Vector3d;
using namespace std::chrono_literals;

constexpr double kDeg = std::numbers::pi / 180.0;
constexpr double kRate_hz = 100.0;
const Time kStart = TimeFromNanoseconds(1'700'000'000'000'000'000);

Time TimeAt(double t_s) { return kStart + DurationFromSeconds(t_s); }

/// What an orientation filter and an alignment leave: a constant turn, a slow one and noise.
class SegmentErrors {
 public:
  struct Sizes {
    double constant_rad = 0.0;
    double slow_rad = 0.0;   ///< standard deviation for each axis, changes within about 5 s
    double noise_rad = 0.0;  ///< standard deviation for each axis, changes within about 0.1 s
  };
  explicit SegmentErrors(const Sizes& sizes) : sizes_(sizes), random_(20240517) {
    for (std::size_t i = 0; i < kSegmentCount; ++i) {
      constant_[i] = sizes.constant_rad * random_.Gaussian3();
      slow_[i] = sizes.slow_rad * random_.Gaussian3();
      fast_[i] = sizes.noise_rad * random_.Gaussian3();
    }
  }
  Quaterniond Apply(std::size_t i, const Quaterniond& q_earth_segment) {
    Follow(slow_[i], 5.0, sizes_.slow_rad);
    Follow(fast_[i], 0.1, sizes_.noise_rad);
    return math::ExpSO3(slow_[i] + fast_[i]) * q_earth_segment * math::ExpSO3(constant_[i]);
  }

 private:
  // First-order Gauss–Markov: x' = a·x + √(1 − a²)·σ·n, a = e^(−dt/τ).
  void Follow(Vector3d& x, double tau_s, double sigma_rad) {
    const double a = std::exp(-1.0 / (kRate_hz * tau_s));
    x = a * x + std::sqrt(1.0 - a * a) * sigma_rad * random_.Gaussian3();
  }
  Sizes sizes_;
  simulation::Random random_;
  PerSegment<Vector3d> constant_;
  PerSegment<Vector3d> slow_;
  PerSegment<Vector3d> fast_;
};

class RootTrackerTest : public ::testing::Test {
 protected:
  const BodyDefinition body_ = *MakeDefaultBody(BodyId{1});
  const ForwardKinematics kinematics_{body_};
  const simulation::PersonMotion motion_ = *simulation::PersonMotion::Make(
      *simulation::MakePersonShape(kDefaultBodyHeight_m), {.start = {.heading_rad = 0.7}});
  RootTracker tracker_{body_};
  BodyPose pose_;

  static PerSegment<SegmentMotion> MotionOf(const simulation::PersonPose& truth) {
    PerSegment<SegmentMotion> motion;
    for (std::size_t i = 0; i < kSegmentCount; ++i) {
      const auto& rigid = truth.segments[i];
      motion[i] = {.usable = true,
                   .rate_rad_s = static_cast<float>(rigid.w_earth_local_rad_s.norm()),
                   .accel_m_s2 = static_cast<float>(rigid.a_earth_local_m_s2.norm())};
    }
    return motion;
  }

  /// The pose of the simulated person at `t_s` with errors; toes carry no sensor.
  simulation::PersonPose Pose(double t_s, SegmentErrors& errors) {
    const simulation::PersonPose truth = motion_.At(t_s);
    for (std::size_t i = 0; i < kSegmentCount; ++i) {
      pose_.known[i] = i != Index(Segment::kLeftToe) && i != Index(Segment::kRightToe);
      pose_.q_earth_segment[i] =
          errors.Apply(i, math::QuaternionFromMatrix(truth.segments[i].R_earth_local));
    }
    kinematics_.Fill(pose_);
    kinematics_.Place(Vector3d::Zero(), pose_);
    tracker_.Update(TimeAt(t_s), MotionOf(truth), pose_);
    return truth;
  }

  test_support::WalkingSlip Walk(double seconds, const SegmentErrors::Sizes& sizes) {
    SegmentErrors errors(sizes);
    test_support::WalkingSlip slip(body_);
    for (int i = 0; i < static_cast<int>(seconds * kRate_hz); ++i) {
      const auto truth = Pose(i / kRate_hz, errors);
      slip.Add(truth, pose_.q_earth_segment, pose_.p_earth_segment_m);
    }
    slip.Finish();
    std::cout << slip.steps() << " contacts, slip median " << 1e3 * slip.slip_m(0.5) << " mm, 95 % "
              << 1e3 * slip.slip_m(0.95) << " mm, worst " << 1e3 * slip.worst_slip_m()
              << " mm, standing " << 1e3 * slip.worst_standing_m() << " mm; way "
              << slip.said_way_m() << " m of " << slip.true_way_m() << " m; farthest off "
              << slip.farthest_off_m() << " m; deepest " << 1e3 * slip.deepest_m() << " mm\n";
    return slip;
  }
};

TEST_F(RootTrackerTest, WithTrueOrientationsFeetStandStillForFiveMinutes) {
  const auto slip = Walk(300.0, {});
  EXPECT_GT(slip.steps(), 500U);
  EXPECT_LT(slip.worst_slip_m(), 0.005);
  EXPECT_LT(slip.deepest_m(), 1e-6);
  EXPECT_NEAR(slip.said_way_m() / slip.true_way_m(), 1.0, 0.01);
}

TEST_F(RootTrackerTest, WithErrorsOfAFilterFeetSlipLessThanTwoCentimetresAStep) {
  const auto slip =
      Walk(300.0, {.constant_rad = 1.5 * kDeg, .slow_rad = 1.0 * kDeg, .noise_rad = 0.2 * kDeg});
  EXPECT_LT(slip.worst_slip_m(), 0.02);
  EXPECT_LT(slip.deepest_m(), 1e-6);
  EXPECT_NEAR(slip.said_way_m() / slip.true_way_m(), 1.0, 0.03);
}

TEST_F(RootTrackerTest, AFootIsOnTheGroundWhenItTrulyIs) {
  SegmentErrors none({});
  int agree = 0;
  int missed = 0;
  int frames = 0;
  for (double t_s = 0.0; t_s < 60.0; t_s += 1.0 / kRate_hz) {
    const auto truth = Pose(t_s, none);
    for (const Segment foot : {Segment::kRightFoot, Segment::kLeftFoot}) {
      const std::uint32_t bit = 1U << Index(foot);
      missed += (truth.contacts & bit) > (tracker_.contacts() & bit) ? 1 : 0;
      agree += (truth.contacts & bit) == (tracker_.contacts() & bit) ? 1 : 0;
      ++frames;
    }
    EXPECT_NE(tracker_.contacts(), 0U) << "walking, some foot always is; t = " << t_s;
  }
  std::cout << "contacts agree in " << 100.0 * agree / frames << " % of the frames, missed in "
            << 100.0 * missed / frames << " %\n";
  EXPECT_LT(missed, 0.01 * frames);
  // The simulated foot leaves the ground without speed: it moves for some 40 ms of each swing (of
  // about 430 ms) before it can be told from one that rests.
  EXPECT_LT(frames - agree - missed, 0.04 * frames);
}

TEST_F(RootTrackerTest, ToesLieFlatWhileTheHeelRises) {
  SegmentErrors none({});
  double lowest_m = 1.0;
  double steepest_rad = 0.0;
  for (double t_s = 0.0; t_s < 30.0; t_s += 1.0 / kRate_hz) {
    (void)Pose(t_s, none);
    for (const auto& [foot, toe] : {std::pair{Segment::kRightFoot, Segment::kRightToe},
                                    std::pair{Segment::kLeftFoot, Segment::kLeftToe}}) {
      if ((tracker_.contacts() & (1U << Index(toe))) == 0) {
        continue;
      }
      lowest_m = std::min(lowest_m, kinematics_.End_m(toe, pose_).z());
      const Vector3d x = pose_.q_earth_segment[Index(foot)] * Vector3d(Vector3d::UnitX());
      steepest_rad = std::max(steepest_rad, std::asin(-x.z()));
    }
  }
  EXPECT_GT(steepest_rad, 30 * kDeg) << "the test must see a heel rise";
  EXPECT_GT(lowest_m, -0.005) << "tips of toes that are on the ground do not sink";
}

TEST_F(RootTrackerTest, WithoutUsableLegsThePersonIsWhereTheFixesAre) {
  for (int i = 0; i < 100; ++i) {
    BodyPose pose;
    const Vector3d fix_m(0.02 * i, -0.01 * i, 1.0);  // 2.2 m/s, faster than corrections may be
    tracker_.OnPositionFix(fix_m, Matrix3d::Zero(), TimeAt(0.01 * i));
    tracker_.Update(TimeAt(0.01 * i), {}, pose);
    EXPECT_LT((tracker_.p_earth_root_m() - fix_m).norm(), 1e-9);
  }
}

class RootTrackerFixTest : public RootTrackerTest {
 protected:
  SegmentErrors none_{{}};
  const Matrix3d exact_ = Matrix3d::Zero();

  Vector3d Root(double t_s) {
    (void)Pose(t_s, none_);
    return tracker_.p_earth_root_m();
  }
};

TEST_F(RootTrackerFixTest, TheFirstFixPlacesThePersonAndTheNextOnesBlend) {
  const Vector3d first = Root(0.0);
  tracker_.OnPositionFix(first + Vector3d(5.0, -3.0, 0.0), exact_, {});
  EXPECT_LT((Root(0.01) - first - Vector3d(5.0, -3.0, 0.0)).norm(), 1e-6);

  const Vector3d before = tracker_.p_earth_root_m();
  tracker_.OnPositionFix(before + Vector3d(0.3, 0.0, 0.1), exact_, {});
  Vector3d last = before;
  for (int i = 2; i < 80; ++i) {
    const Vector3d now = Root(0.01 * i);
    EXPECT_LT((now - last).norm(), 0.5 * 0.01 + 1e-9) << "0.5 m/s is how fast it is made good";
    last = now;
  }
  EXPECT_LT((last - before - Vector3d(0.3, 0.0, 0.1)).norm(), 1e-6);
  EXPECT_NEAR(tracker_.ground_m(), 0.1, 1e-6) << "the height of a fix is that of the ground";
}

TEST_F(RootTrackerFixTest, OneThatIsFarOffIsBelievedAtOnce) {
  (void)Root(0.0);
  tracker_.OnPositionFix(Root(0.01), exact_, {});
  const Vector3d before = Root(0.02);
  tracker_.OnPositionFix(before + Vector3d(10.0, 0.0, 0.0), exact_, {});
  EXPECT_NEAR((Root(0.03) - before).x(), 10.0, 1e-6);
}

TEST_F(RootTrackerFixTest, NoisyFixesAreAveragedAndKeepAWalkerFromDrifting) {
  // An error of the legs' lengths of 5 %: the way of the contacts alone is 5 % wrong.
  const BodyDefinition longer = *MakeDefaultBody(BodyId{1}, 1.05 * kDefaultBodyHeight_m);
  const ForwardKinematics kinematics(longer);
  RootTracker alone(longer);
  RootTracker aided(longer);
  simulation::Random random(20240517);
  const auto motion = *simulation::PersonMotion::Make(
      *simulation::MakePersonShape(kDefaultBodyHeight_m),
      {.schedule = {.phases = {{.kind = simulation::PhaseKind::kWalk, .path = {{40.0}}},
                               {.kind = simulation::PhaseKind::kTurn,
                                .duration_s = 4.0,
                                .turn_rad = std::numbers::pi},
                               {.kind = simulation::PhaseKind::kWalk, .path = {{40.0}}},
                               {.kind = simulation::PhaseKind::kTurn,
                                .duration_s = 4.0,
                                .turn_rad = -std::numbers::pi}}}});
  double off_alone_m = 0.0;
  double sum_aided_m2 = 0.0;
  double worst_step_m = 0.0;
  int frames = 0;
  Vector3d last = Vector3d::Zero();
  for (int i = 0; i < 3500; ++i) {
    const double t_s = 0.01 * i;
    const auto truth = motion.At(t_s);
    BodyPose pose;
    pose.known.fill(true);
    for (std::size_t s = 0; s < kSegmentCount; ++s) {
      pose.q_earth_segment[s] = math::QuaternionFromMatrix(truth.segments[s].R_earth_local);
    }
    const PerSegment<SegmentMotion> sensors = MotionOf(truth);
    kinematics.Place(Vector3d::Zero(), pose);
    const Vector3d& root_m = truth.segments[0].p_earth_local_m;
    if (i % 20 == 0) {  // 5 Hz, 10 cm
      aided.OnPositionFix(root_m + 0.1 * random.Gaussian3(), 0.01 * Matrix3d::Identity(),
                          TimeAt(t_s));
    }
    BodyPose copy = pose;
    alone.Update(TimeAt(t_s), sensors, copy);
    aided.Update(TimeAt(t_s), sensors, pose);
    off_alone_m = std::max(off_alone_m, (alone.p_earth_root_m() - root_m).head<2>().norm());
    if (i > 200) {
      sum_aided_m2 += (aided.p_earth_root_m() - root_m).head<2>().squaredNorm();
      worst_step_m = std::max(worst_step_m, (aided.p_earth_root_m() - last).norm());
      ++frames;
    }
    last = aided.p_earth_root_m();
  }
  const double aided_m = std::sqrt(sum_aided_m2 / frames);
  std::cout << "alone " << off_alone_m << " m off, aided " << aided_m << " m (RMS)\n";
  EXPECT_GT(off_alone_m, 1.0);
  EXPECT_LT(aided_m, 0.1) << "better than one fix alone (0.14 m in the plane)";
  EXPECT_LT(worst_step_m, 0.04) << "no jump: walking 1.5 m/s and 0.5 m/s of correction make 2 cm";
}

TEST_F(RootTrackerTest, WithoutUsableLegsTheRootStaysAtStandingHeight) {
  for (int i = 0; i < 10; ++i) {
    BodyPose pose;
    pose.known[0] = true;
    pose.q_earth_segment[0] = math::ExpSO3({0.0, 0.1 * i, 0.0});
    kinematics_.Fill(pose);
    kinematics_.Place(Vector3d::Zero(), pose);
    tracker_.Update(TimeAt(0.01 * i), {}, pose);
    EXPECT_LT(
        (pose.p_earth_segment_m[0] - Vector3d(0.0, 0.0, kStandingRootHeight * kDefaultBodyHeight_m))
            .norm(),
        1e-9);
    EXPECT_EQ(tracker_.contacts(), 0U);
  }
}

TEST_F(RootTrackerTest, NeitherAGapNorAnotherAlignmentMovesThePerson) {
  SegmentErrors none({});
  for (double t_s = 6.0; t_s < 9.0; t_s += 0.01) {
    (void)Pose(t_s, none);  // walking
  }
  const Vector3d before = tracker_.p_earth_root_m();
  (void)Pose(12.0, none);  // 3 s without a skeleton: the pose is another one
  EXPECT_LT((tracker_.p_earth_root_m() - before).head<2>().norm(), 1e-12);
  tracker_.Restart();
  (void)Pose(12.01, none);
  EXPECT_LT((tracker_.p_earth_root_m() - before).head<2>().norm(), 1e-12);
}

TEST_F(RootTrackerTest, AFrameThatIsNoNumberIsForgotten) {
  SegmentErrors none({});
  for (int i = 0; i < 10; ++i) {
    (void)Pose(0.01 * i, none);
  }
  const Vector3d before = tracker_.p_earth_root_m();
  BodyPose broken = pose_;
  for (Vector3d& p_m : broken.p_earth_segment_m) {
    p_m.setConstant(std::numeric_limits<double>::quiet_NaN());
  }
  tracker_.Update(TimeAt(0.1), MotionOf(motion_.At(0.1)), broken);
  EXPECT_EQ(tracker_.p_earth_root_m(), before);
  (void)Pose(0.11, none);
  EXPECT_LT((tracker_.p_earth_root_m() - before).norm(), 1e-3);
}

TEST_F(RootTrackerTest, WhoKneelsIsOnTheKnees) {
  PerSegment<SegmentMotion> sensors;
  sensors.fill({.usable = true});
  // Thighs upright, shanks level, soles up.
  const Quaterniond back = math::ExpSO3({0.0, std::numbers::pi / 2.0, 0.0});
  for (int i = 0; i < 10; ++i) {
    BodyPose pose;
    pose.known.fill(true);
    for (const Segment segment : {Segment::kRightLowerLeg, Segment::kLeftLowerLeg}) {
      pose.q_earth_segment[Index(segment)] = back;
    }
    for (const Segment segment :
         {Segment::kRightFoot, Segment::kRightToe, Segment::kLeftFoot, Segment::kLeftToe}) {
      pose.q_earth_segment[Index(segment)] = back * back;
    }
    kinematics_.Place(Vector3d::Zero(), pose);
    tracker_.Update(TimeAt(0.01 * i), sensors, pose);
    EXPECT_GE(pose.p_earth_segment_m[Index(Segment::kRightLowerLeg)].z(), 0.0);
    EXPECT_LT(pose.p_earth_segment_m[Index(Segment::kPelvis)].z(), 0.6);
  }
  EXPECT_NE(tracker_.contacts() & (1U << Index(Segment::kRightLowerLeg)), 0U);
}

}  // namespace
}  // namespace limbcast::body
