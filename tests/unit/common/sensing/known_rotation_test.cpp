#include "common/sensing/known_rotation.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "common/math/rotation.hpp"
#include "tests/unit/common/sensing/calibration_scene.hpp"

namespace limbcast::sensing {
namespace {

constexpr double kQuarter_rad = std::numbers::pi / 2.0;

scene::Handling QuarterTurns(int axes) {
  scene::Handling handling;
  Eigen::Quaterniond q = Eigen::Quaterniond::Identity();
  handling.poses.push_back(q);
  for (int axis = 0; axis < axes; ++axis) {
    for (const double sign : {1.0, -1.0}) {
      q = q * math::ExpSO3(sign * kQuarter_rad * Eigen::Vector3d::Unit(axis));
      handling.poses.push_back(q);
    }
  }
  return handling;
}

// The error of Eq. (31): noise n√(T/2) of the integral and δT of the null, over the angle; the null
// is known to n√(1/(2·t)) from rests of t, twice. Four sigma over 20 sensors; a second turn about
// each axis is not counted on.
TEST(KnownRotationTest, QuarterTurnsGiveTheScaleWithinTheErrorOfTheIntegral) {
  const auto errors = scene::FactoryErrors();
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    const auto samples = scene::Read(QuarterTurns(3), errors, seed);
    const auto poses = FindRestPoses(samples);
    const auto scales = GyroScalesFromTurns(samples, poses, kQuarter_rad);
    ASSERT_TRUE(scales.ok()) << scales.error().message;
    const double turn_s = 3.5;
    const double noise = errors.gyro.noise_rthz * std::sqrt(turn_s / 2.0);
    const double null = errors.gyro.noise_rthz * std::sqrt(1.0 / 4.0 / 2.0) * turn_s;
    const double walk = errors.gyro.bias_walk_rts * std::sqrt(turn_s) * turn_s;
    const double sigma = (noise + null + walk) / kQuarter_rad;
    const auto truth = scene::TruthOf(errors, seed);
    for (Eigen::Index axis = 0; axis < 3; ++axis) {
      EXPECT_NEAR((*scales)(axis)*truth.gyro.gain(axis, axis), 1.0, 4.0 * sigma) << seed;
    }
  }
}

TEST(KnownRotationTest, AnAxisThatWasNotTurnedIsNamed) {
  const auto samples = scene::Read(QuarterTurns(1), scene::FactoryErrors(), 1);
  EXPECT_EQ(GyroScalesFromTurns(samples, FindRestPoses(samples), kQuarter_rad).error().message,
            "scale: no known rotation about axis y, z alone, from rest to rest");
  EXPECT_FALSE(GyroScalesFromTurns({}, {}, kQuarter_rad).ok());
}

}  // namespace
}  // namespace limbcast::sensing
