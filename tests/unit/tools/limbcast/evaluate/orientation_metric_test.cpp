#include "tools/limbcast/evaluate/orientation_metric.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "common/math/rotation.hpp"

namespace limbcast::tool {
namespace {

using Eigen::Quaterniond;

constexpr double kDeg = 3.14159265358979323846 / 180.0;

TEST(OrientationMetricTest, HeadingAndInclinationAreTheTwistAndTheSwing) {
  const Quaterniond q_reference = math::ExpSO3({0.4, -0.2, 1.0});
  const Quaterniond q_estimate =
      math::ExpSO3({0.0, 0.0, 0.10}) * math::ExpSO3({0.05, 0.0, 0.0}) * q_reference;
  const OrientationError error = ErrorBetween(q_estimate, q_reference);
  EXPECT_NEAR(error.heading_rad, 0.10, 1e-12);
  EXPECT_NEAR(error.inclination_rad, 0.05, 1e-12);
  EXPECT_NEAR(error.total_rad, math::AngleBetween_rad(q_estimate, q_reference), 1e-12);
}

// The definition of the data set, literally.
TEST(OrientationMetricTest, AgreesWithTheFormulasOfTheBenchmark) {
  std::mt19937 rng(7);
  std::normal_distribution<double> normal;
  for (int trial = 0; trial < 1000; ++trial) {
    const Quaterniond a =
        Quaterniond(normal(rng), normal(rng), normal(rng), normal(rng)).normalized();
    const Quaterniond b =
        Quaterniond(normal(rng), normal(rng), normal(rng), normal(rng)).normalized();
    const Quaterniond e = a * b.conjugate();
    const OrientationError error = ErrorBetween(a, b);
    EXPECT_NEAR(error.total_rad, 2.0 * std::acos(std::min(1.0, std::abs(e.w()))), 1e-6);
    EXPECT_NEAR(error.heading_rad, 2.0 * std::atan(std::abs(e.z() / e.w())), 1e-6);
    EXPECT_NEAR(error.inclination_rad, 2.0 * std::acos(std::min(1.0, std::hypot(e.w(), e.z()))),
                1e-6);
  }
}

TEST(ErrorStatisticsTest, IsTheRootMeanSquareInDegrees) {
  ErrorStatistics statistics;
  EXPECT_EQ(statistics.total_rms_deg(), 0.0);
  statistics.Add({.total_rad = 3.0 * kDeg, .heading_rad = 0.0, .inclination_rad = 1.0 * kDeg});
  statistics.Add(
      {.total_rad = 4.0 * kDeg, .heading_rad = 2.0 * kDeg, .inclination_rad = 1.0 * kDeg});
  EXPECT_NEAR(statistics.total_rms_deg(), std::sqrt(12.5), 1e-12);
  EXPECT_NEAR(statistics.heading_rms_deg(), std::sqrt(2.0), 1e-12);
  EXPECT_NEAR(statistics.inclination_rms_deg(), 1.0, 1e-12);
  EXPECT_NEAR(statistics.total_max_deg(), 4.0, 1e-12);
  EXPECT_EQ(statistics.count(), 2U);
}

}  // namespace
}  // namespace limbcast::tool
