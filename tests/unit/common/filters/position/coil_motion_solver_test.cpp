#include "common/filters/position/coil_motion_solver.hpp"

#include <gtest/gtest.h>

#include <Eigen/LU>
#include <array>
#include <cmath>
#include <random>

#include "common/math/rotation.hpp"

namespace limbcast::filters {
namespace {

constexpr double kSigma_tesla = 27.4e-9;

Eigen::Vector3d Normal3(std::mt19937& rng) {
  std::normal_distribution<double> normal;
  const double x = normal(rng);
  const double y = normal(rng);
  return {x, y, normal(rng)};
}

struct Case {
  CoilStart truth;
  Eigen::Vector3d v_m_s;
  std::array<CoilObservation, 3> pulses;
};

// A sensor that moves with a velocity that dp does not have.
Case MakeCase(std::mt19937& rng, double range_m) {
  Case made;
  made.truth = {range_m * Normal3(rng).normalized(), math::ExpSO3(Normal3(rng)).toRotationMatrix()};
  made.v_m_s = 0.3 * Normal3(rng);
  for (int c = 0; c < 3; ++c) {
    CoilObservation o;
    o.coil = c;
    o.current_a = 1.5;
    o.time_from_reference_s = 0.2 * (c - 1);
    o.dp_emitter_m = o.time_from_reference_s * made.v_m_s;
    o.field_tesla = PredictCoilField_tesla({}, o, made.truth) + kSigma_tesla * Normal3(rng);
    o.sigma_tesla = std::hypot(kSigma_tesla, 0.01 * o.field_tesla.norm());
    o.dp_emitter_m.setZero();
    made.pulses[static_cast<std::size_t>(c)] = o;
  }
  return made;
}

TEST(CoilMotionSolverTest, FindsPositionAndVelocityWhenTheOrientationIsAboutKnown) {
  std::mt19937 rng(3);
  int found = 0;
  double chi2 = 0.0;
  constexpr int kTrials = 200;
  for (int trial = 0; trial < kTrials; ++trial) {
    const Case given = MakeCase(rng, 0.35);
    const CoilMotionPrior prior{
        .R_sensor_emitter =
            math::ExpSO3(0.05 * Normal3(rng)).toRotationMatrix() * given.truth.R_sensor_emitter,
        .sigma_rad = 0.05};
    CoilPoseConfig config;
    config.max_sigma_m = 0.5;
    const CoilMotion motion = SolveCoilMotion(
        config, {}, given.pulses,
        {.predicted_emitter_m = given.truth.p_emitter_sensor_m, .half_space = {}}, prior);
    if (!motion.accepted) {
      continue;
    }
    const Eigen::Vector3d error_m = given.truth.p_emitter_sensor_m - motion.p_emitter_sensor_m;
    const double nees = error_m.dot(motion.cov.topLeftCorner<3, 3>().inverse() * error_m) / 3.0;
    chi2 += std::min(nees, 10.0);
    found += error_m.norm() < 0.05 ? 1 : 0;
  }
  EXPECT_GT(found, kTrials * 9 / 10);
  EXPECT_LT(chi2 / kTrials, 2.0);
}

TEST(CoilMotionSolverTest, RefusesWhatDoesNotFit) {
  std::mt19937 rng(4);
  Case given = MakeCase(rng, 0.35);
  const HemisphereRule rule{.predicted_emitter_m = given.truth.p_emitter_sensor_m,
                            .half_space = {}};
  const CoilMotionPrior prior{.R_sensor_emitter = given.truth.R_sensor_emitter};
  EXPECT_FALSE(SolveCoilMotion({}, {}, given.pulses, {}, prior).accepted);
  given.pulses[0].field_tesla *= 20.0;
  EXPECT_FALSE(SolveCoilMotion({}, {}, given.pulses, rule, prior).accepted);
  given.pulses[1].coil = 0;
  EXPECT_FALSE(SolveCoilMotion({}, {}, given.pulses, rule, prior).accepted);
}

}  // namespace
}  // namespace limbcast::filters
