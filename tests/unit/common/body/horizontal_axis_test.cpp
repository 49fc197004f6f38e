#include "common/body/horizontal_axis.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace limbcast::body {
namespace {

constexpr double kPi = std::numbers::pi;
constexpr std::size_t kStride = 50;  // samples

/// `along` swings along a direction, `across` to the left of it; `up` upwards.
template <typename Along, typename Across, typename Up>
std::vector<Eigen::Vector3d> Vectors(double direction_rad, Along along, Across across, Up up) {
  std::vector<Eigen::Vector3d> out;
  for (std::size_t i = 0; i < 10 * kStride; ++i) {
    const double phase = 2.0 * kPi * static_cast<double>(i) / kStride;
    const double c = std::cos(direction_rad);
    const double s = std::sin(direction_rad);
    out.emplace_back(c * along(phase) - s * across(phase), s * along(phase) + c * across(phase),
                     up(phase));
  }
  return out;
}

double LineBetween_rad(double a, double b) { return std::abs(std::remainder(a - b, kPi)); }

TEST(HorizontalAxisTest, TheLineOfGreatestScatterIsFoundWhicheverWayItLies) {
  for (double direction_rad = -3.0; direction_rad < 3.0; direction_rad += 0.37) {
    const auto vectors = Vectors(
        direction_rad, [](double p) { return 3.0 * std::sin(p); },
        [](double p) { return 0.5 * std::cos(p); }, [](double) { return 9.0; });
    const HorizontalAxis axis = PrincipalAxis(vectors);
    EXPECT_LT(LineBetween_rad(axis.direction_rad, direction_rad), 1e-9) << direction_rad;
    // 5° and 60° times the ratio of the variances, 1/36.
    EXPECT_NEAR(axis.sigma_rad, (5.0 + 60.0 / 36.0) * kPi / 180.0, 1e-3);
  }
}

TEST(HorizontalAxisTest, EvenScatterSaysNothing) {
  const auto vectors = Vectors(
      0.3, [](double p) { return std::sin(p); }, [](double p) { return std::cos(p); },
      [](double) { return 0.0; });
  EXPECT_GT(PrincipalAxis(vectors).sigma_rad, 1.0);
  EXPECT_GT(PrincipalAxis(std::vector<Eigen::Vector3d>(100, Eigen::Vector3d::Zero())).sigma_rad,
            1.5);
}

TEST(HorizontalAxisTest, WhatRepeatsWithEveryStepIsForwardThoughSidewaysIsStronger) {
  for (double direction_rad = -3.0; direction_rad < 3.0; direction_rad += 0.37) {
    const auto vectors = Vectors(
        direction_rad, [](double p) { return std::sin(2.0 * p); },
        [](double p) { return 2.0 * std::sin(p + 0.4); }, [](double) { return 0.0; });
    const HorizontalAxis axis = SymmetricAxis(vectors, kStride / 2);
    EXPECT_LT(LineBetween_rad(axis.direction_rad, direction_rad), 1e-9) << direction_rad;
    EXPECT_LT(axis.sigma_rad, 0.2);
  }
}

TEST(HorizontalAxisTest, AnInvertedPendulumIsFastestWhereItsVerticalAccelerationIsGreatest) {
  // Velocity cos(2p) along the way, vertical acceleration in phase with it.
  const auto accel = Vectors(
      1.1, [](double p) { return -std::sin(2.0 * p); }, [](double p) { return std::sin(p); },
      [](double p) { return std::cos(2.0 * p); });
  EXPECT_NEAR(PendulumForwardness(accel, 1.1, kStride / 2, 50.0), 1.0, 0.02);
  EXPECT_NEAR(PendulumForwardness(accel, 1.1 + kPi, kStride / 2, 50.0), -1.0, 0.02);
  EXPECT_EQ(PendulumForwardness({}, 0.0, 10, 50.0), 0.0);
}

}  // namespace
}  // namespace limbcast::body
