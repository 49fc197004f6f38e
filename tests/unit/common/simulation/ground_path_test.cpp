#include "common/simulation/ground_path.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <numbers>

namespace limbcast::simulation {
namespace {

constexpr double kPi = std::numbers::pi;
constexpr std::array<PathPiece, 4> kWay = {{{1.3}, {2.0, 0.5 * kPi}, {0.7}, {3.0, -kPi}}};

TEST(GroundPathTest, WalksOneMetreForEveryMetre) {
  const GroundPath path(FloorPose{1.0, 2.0, 0.3}, kWay);
  EXPECT_NEAR(path.length_m(), 7.0, 1e-12);
  for (double u_m = -0.5; u_m < 7.5; u_m += 0.083) {
    const MovingFloorPose at = path.At({u_m, 1.0, 0.0});
    const double before_x_m = path.At(Jet{u_m - 1e-5}).x_m.value;
    const double after_x_m = path.At(Jet{u_m + 1e-5}).x_m.value;
    EXPECT_NEAR(std::hypot(at.x_m.rate, at.y_m.rate), 1.0, 1e-12);
    EXPECT_NEAR(at.x_m.rate, (after_x_m - before_x_m) / 2e-5, 1e-8) << "at " << u_m;
    EXPECT_NEAR(
        std::remainder(std::atan2(at.y_m.rate, at.x_m.rate) - at.heading_rad.value, 2.0 * kPi), 0.0,
        1e-12);
  }
}

TEST(GroundPathTest, AccelerationIsThatOfTheRate) {
  const GroundPath path({}, kWay);
  for (double u_m = 0.05; u_m < 7.0; u_m += 0.13) {
    const double speed_m_s = 1.2;
    const Jet at = path.At({u_m, speed_m_s, 0.4}).y_m;
    const auto rate = [&](double dt_s) {
      return path.At({u_m + speed_m_s * dt_s, speed_m_s + 0.4 * dt_s, 0.4}).y_m.rate;
    };
    EXPECT_NEAR(at.accel, (rate(1e-5) - rate(-1e-5)) / 2e-5, 1e-6) << "at " << u_m;
  }
}

TEST(GroundPathTest, ALoopOfTwoHalfTurnsComesHome) {
  const std::array<PathPiece, 4> loop = {{{2.0}, {4.0, kPi}, {2.0}, {4.0, kPi}}};
  const FloorPose start{-3.0, 5.0, 1.1};
  const FloorPose end = GroundPath(start, loop).end();
  EXPECT_NEAR(end.x_m, start.x_m, 1e-10);
  EXPECT_NEAR(end.y_m, start.y_m, 1e-10);
  EXPECT_NEAR(end.heading_rad, start.heading_rad + 2.0 * kPi, 1e-12);
}

TEST(GroundPathTest, ComposeTurnsAndMoves) {
  const FloorPose p = Compose({1.0, 2.0, 0.5 * kPi}, {3.0, 4.0, 0.1});
  EXPECT_NEAR(p.x_m, -3.0, 1e-12);
  EXPECT_NEAR(p.y_m, 5.0, 1e-12);
  EXPECT_NEAR(p.heading_rad, 0.5 * kPi + 0.1, 1e-12);
}

}  // namespace
}  // namespace limbcast::simulation
