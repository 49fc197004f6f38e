#include "common/filters/position/coil_pose_solver.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <random>

#include "common/math/rotation.hpp"

namespace limbcast::filters {
namespace {

using Pulses = std::array<CoilObservation, 3>;
constexpr double kSigma_tesla = 27.4e-9;  // 50 nT · √(1/5 + 1/10), design/position.md section 14

struct Case {
  CoilStart truth;
  Pulses pulses;
};

Eigen::Vector3d Normal3(std::mt19937& rng) {
  std::normal_distribution<double> normal;
  const double x = normal(rng);
  const double y = normal(rng);
  return {x, y, normal(rng)};
}

Case MakeCase(std::mt19937& rng, double range_m, double sigma_tesla) {
  Case made;
  made.truth.p_emitter_sensor_m = range_m * Normal3(rng).normalized();
  made.truth.R_sensor_emitter = math::ExpSO3(2.0 * Normal3(rng)).toRotationMatrix();
  for (int c = 0; c < 3; ++c) {
    CoilObservation& o = made.pulses[static_cast<std::size_t>(c)];
    o.coil = c;
    o.current_a = 1.5;
    o.sigma_tesla = sigma_tesla;
    o.field_tesla = PredictCoilField_tesla({}, o, made.truth) + sigma_tesla * Normal3(rng);
  }
  return made;
}

CoilPose Solve(const Case& given, const Pulses& pulses) {
  return SolveCoilPose({}, {}, pulses,
                       {.predicted_emitter_m = given.truth.p_emitter_sensor_m, .half_space = {}});
}

double Turn_rad(const Case& given, const CoilPose& pose) {
  return math::AngleBetween_rad(math::QuaternionFromMatrix(given.truth.R_sensor_emitter),
                                pose.q_sensor_emitter);
}

struct Figures {
  double rms_m = 0.0;
  double rms_distance_m = 0.0;
  double rms_rad = 0.0;
  double bound_m = 0.0;
  double bound_rad = 0.0;
};

Figures MonteCarlo(double range_m, int trials) {
  std::mt19937 rng(11);
  Figures sum;
  for (int i = 0; i < trials; ++i) {
    const Case given = MakeCase(rng, range_m, kSigma_tesla);
    const CoilPose pose = Solve(given, given.pulses);
    const double distance_m = pose.p_emitter_sensor_m.norm() - range_m;
    sum.rms_m += (pose.p_emitter_sensor_m - given.truth.p_emitter_sensor_m).squaredNorm();
    sum.rms_distance_m += distance_m * distance_m;
    sum.rms_rad += std::pow(Turn_rad(given, pose), 2);
    sum.bound_m += pose.cov_noise.topLeftCorner<3, 3>().trace();
    sum.bound_rad += pose.cov_noise.bottomRightCorner<3, 3>().trace();
  }
  for (double* value :
       {&sum.rms_m, &sum.rms_distance_m, &sum.rms_rad, &sum.bound_m, &sum.bound_rad}) {
    *value = std::sqrt(*value / trials);
  }
  return sum;
}

// Design/position.md section 14, and as many digits as are printed there.
struct Published {
  double range_m;
  double mm;
  double deg;
  double rounding_mm;
  double rounding_deg;
};
class CoilSelfCheckTest : public testing::TestWithParam<Published> {};

TEST_P(CoilSelfCheckTest, LeastSquaresReachThePublishedFigures) {
  const Published& p = GetParam();
  const Figures figures = MonteCarlo(p.range_m, 1500);
  RecordProperty("rms_mm", std::to_string(1e3 * figures.rms_m));
  EXPECT_NEAR(1e3 * figures.rms_m, p.mm, 0.1 * p.mm + p.rounding_mm);
  EXPECT_NEAR(figures.rms_rad * 180.0 / std::numbers::pi, p.deg, 0.1 * p.deg + p.rounding_deg);
}
INSTANTIATE_TEST_SUITE_P(
    Range, CoilSelfCheckTest,
    testing::Values(Published{0.2, 0.7, 0.4, 0.05, 0.05}, Published{0.3, 3.3, 1.3, 0.05, 0.05},
                    Published{0.4, 10.5, 3.0, 0.05, 0.05}, Published{0.5, 25, 5.8, 0.5, 0.05},
                    Published{0.6, 53, 10, 0.5, 0.5}, Published{0.7, 98, 16, 0.5, 0.5}));

class CoilBoundTest : public testing::TestWithParam<double> {};

TEST_P(CoilBoundTest, LeastSquaresAreWithinFifteenPercentOfCramerRao) {
  const Figures figures = MonteCarlo(GetParam(), 1500);
  EXPECT_NEAR(figures.rms_m / figures.bound_m, 1.0, 0.15);
  EXPECT_NEAR(figures.rms_rad / figures.bound_rad, 1.0, 0.15);
}
INSTANTIATE_TEST_SUITE_P(Range_m, CoilBoundTest,
                         testing::Values(0.15, 0.2, 0.3, 0.4, 0.5, 0.6, 0.7));

TEST(CoilPoseSolverTest, DistanceIsManyTimesBetterThanPosition) {
  EXPECT_NEAR(1e3 * MonteCarlo(0.4, 1500).rms_distance_m, 1.3, 0.18);
}

TEST(CoilPoseSolverTest, FindsEveryPoseFromNearTheWindingOn) {
  std::mt19937 rng(12);
  std::uniform_real_distribution<double> range(0.09, 0.6);
  for (int trial = 0; trial < 500; ++trial) {
    const Case given = MakeCase(rng, range(rng), 1e-10);
    const CoilPose pose = Solve(given, given.pulses);
    EXPECT_LT((pose.p_emitter_sensor_m - given.truth.p_emitter_sensor_m).norm(), 2e-3)
        << "range " << given.truth.p_emitter_sensor_m.norm() << " cost " << pose.cost;
  }
}

TEST(CoilPoseSolverTest, UsesKnownMotionBetweenThePulses) {
  std::mt19937 rng(13);
  for (int trial = 0; trial < 50; ++trial) {
    Case given = MakeCase(rng, 0.3, 1e-10);
    Pulses pulses = given.pulses;
    for (CoilObservation& o : pulses) {
      o.R_pulse_reference_sensor = math::ExpSO3(0.2 * Normal3(rng)).toRotationMatrix();
      o.R_reference_pulse_emitter = math::ExpSO3(0.2 * Normal3(rng)).toRotationMatrix();
      o.dp_emitter_m = 0.02 * Normal3(rng);
      o.field_tesla = PredictCoilField_tesla({}, o, given.truth);
    }
    const CoilPose pose = Solve(given, pulses);
    EXPECT_LT((pose.p_emitter_sensor_m - given.truth.p_emitter_sensor_m).norm(), 1e-5);
    EXPECT_LT(Turn_rad(given, pose), 1e-4);
  }
}

TEST(CoilPoseSolverTest, CovarianceGrowsWithTheVelocityThatIsNotKnown) {
  std::mt19937 rng(14);
  Case given = MakeCase(rng, 0.3, kSigma_tesla);
  given.pulses[0].time_from_reference_s = -0.2;
  given.pulses[2].time_from_reference_s = 0.2;
  CoilPoseConfig config;
  const HemisphereRule rule{.predicted_emitter_m = given.truth.p_emitter_sensor_m,
                            .half_space = {}};
  const CoilPose still = SolveCoilPose(config, {}, given.pulses, rule);
  config.var_velocity_m2_s2 = 0.09;
  const CoilPose moving = SolveCoilPose(config, {}, given.pulses, rule);
  const double var_still = still.cov.topLeftCorner<3, 3>().trace();
  EXPECT_GT((moving.cov.topLeftCorner<3, 3>().trace()), 5.0 * var_still);
}

TEST(CoilPoseSolverTest, SaysWhyAPoseIsNotAccepted) {
  std::mt19937 rng(15);
  const Case near = MakeCase(rng, 0.3, kSigma_tesla);
  EXPECT_EQ(Solve(near, near.pulses).verdict, CoilPoseVerdict::kAccepted);
  EXPECT_EQ(SolveCoilPose({}, {}, near.pulses, {}).verdict, CoilPoseVerdict::kUndecided);
  Pulses missing = near.pulses;
  missing[1].coil = 0;
  EXPECT_EQ(Solve(near, missing).verdict, CoilPoseVerdict::kMissingCoil);
  missing = near.pulses;
  missing[1].field_tesla.x() = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(Solve(near, missing).verdict, CoilPoseVerdict::kMissingCoil);
  Pulses wrong = near.pulses;
  wrong[0].field_tesla *= 2.0;
  EXPECT_EQ(Solve(near, wrong).verdict, CoilPoseVerdict::kPoorFit);
  const Case far = MakeCase(rng, 1.4, 1e-10);
  EXPECT_EQ(Solve(far, far.pulses).verdict, CoilPoseVerdict::kTooFar);
  const Case faint = MakeCase(rng, 0.9, kSigma_tesla);
  EXPECT_EQ(Solve(faint, faint.pulses).verdict, CoilPoseVerdict::kTooUncertain);
}

TEST(CoilPoseSolverTest, CoilsApartSayOnWhichSideTheSensorIs) {
  sensing::CoilSource apart;
  apart.centre_m.col(0) = Eigen::Vector3d(0.0, 0.12, 0.0);
  apart.centre_m.col(1) = Eigen::Vector3d(0.0, -0.12, 0.0);
  std::mt19937 rng(12);
  int right = 0;
  constexpr int kTrials = 300;
  for (int i = 0; i < kTrials; ++i) {
    Case given = MakeCase(rng, 0.3 + 0.001 * i, 0.0);
    for (CoilObservation& o : given.pulses) {
      o.sigma_tesla = kSigma_tesla;
      o.field_tesla = PredictCoilField_tesla(apart, o, given.truth) + kSigma_tesla * Normal3(rng);
    }
    const CoilPose pose = SolveCoilPose({}, apart, given.pulses, {});
    right += pose.verdict == CoilPoseVerdict::kAccepted &&
                     pose.p_emitter_sensor_m.dot(given.truth.p_emitter_sensor_m) > 0.0
                 ? 1
                 : 0;
    EXPECT_FALSE(pose.verdict == CoilPoseVerdict::kAccepted &&
                 pose.p_emitter_sensor_m.dot(given.truth.p_emitter_sensor_m) < 0.0)
        << "an undecided side is no answer, a wrong one is worse";
    // Concentric coils cannot say it without a rule.
    const Case concentric = MakeCase(rng, 0.3, kSigma_tesla);
    EXPECT_EQ(SolveCoilPose({}, {}, concentric.pulses, {}).verdict, CoilPoseVerdict::kUndecided);
  }
  EXPECT_GE(right, kTrials * 4 / 5) << "of 30 to 60 cm";
}

}  // namespace
}  // namespace limbcast::filters
