#include "common/sensing/null_and_scale.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "tests/unit/common/sensing/calibration_scene.hpp"

namespace limbcast::sensing {
namespace {

constexpr double kG = simulation::kGravity_m_s2;

TEST(NullAndScaleTest, Equations29And30AreExactForOneAxis) {
  simulation::Random random(20011115);
  for (int trial = 0; trial < 100; ++trial) {
    const double gain = random.Uniform(0.5, 2.0);
    const double bias = random.Uniform(-3.0, 3.0);
    const auto line = NullAndScaleFrom(gain * kG + bias, -gain * kG + bias, kG);
    ASSERT_TRUE(line.ok());
    EXPECT_NEAR(line->null, bias, 1e-12);
    EXPECT_NEAR(line->scale, 1.0 / gain, 1e-12);
  }
  EXPECT_FALSE(NullAndScaleFrom(1.0, 1.0, kG).ok());
}

// Held off the vertical by θ, an axis reads g·cos θ: the scale comes out at most 1/cos θ too large.
TEST(NullAndScaleTest, SixPositionsAreWithinTheErrorOfTheirTilt) {
  constexpr double kTilt_rad = 0.03;
  for (std::uint64_t seed = 1; seed <= 50; ++seed) {
    std::vector<Eigen::Vector3d> means;
    for (const auto& q : scene::SixFaces(0.3, kTilt_rad, seed).poses) {
      means.push_back(scene::IdealAt(q, Eigen::Vector3d::Zero()).accel_m_s2);
    }
    const auto triad = SixPositionAccel(means, kG);
    ASSERT_TRUE(triad.ok());
    const double most = 1.0 / std::cos(std::sqrt(2.0) * kTilt_rad) - 1.0;  // tilt about two axes
    for (Eigen::Index axis = 0; axis < 3; ++axis) {
      EXPECT_GE(triad->matrix(axis, axis), 1.0 - 1e-12);
      EXPECT_LE(triad->matrix(axis, axis), 1.0 + most + 1e-12);
      EXPECT_LE(std::abs(triad->offset(axis)), kG * most / 2.0 + 1e-12);
    }
  }
}

TEST(NullAndScaleTest, AMissingPositionIsNamed) {
  const std::vector<Eigen::Vector3d> means = {{kG, 0, 0}, {-kG, 0, 0}, {0, kG, 0}, {0, 0, kG}};
  EXPECT_EQ(SixPositionAccel(means, kG).error().message,
            "positions missing: hold still with -y, -z up");
  EXPECT_FALSE(SixPositionAccel({}, kG).ok());
}

// Extremes of N readings with noise σ lie σ√(2 ln N) too far out on both sides at most (Cramér
// 1946, section 28.6), and 1 − cos of the nearest approach too far in.
TEST(NullAndScaleTest, MinMaxIsWithinTheErrorOfItsExtremes) {
  constexpr double kSigma_tesla = 0.3e-6;
  constexpr int kReadings = 3000;
  const Eigen::Vector3d hard_iron(20e-6, -35e-6, 8e-6);
  const Eigen::Vector3d gain(1.03, 0.98, 0.95);
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    simulation::Random random(seed);
    std::vector<Eigen::Vector3d> readings;
    for (int i = 0; i < kReadings; ++i) {
      const Eigen::Vector3d field =
          random.Rotation() * Eigen::Vector3d(scene::kField_tesla, 0.0, 0.0);
      readings.push_back(gain.cwiseProduct(field) + hard_iron + kSigma_tesla * random.Gaussian3());
    }
    const auto triad = MinMaxMag(readings, scene::kField_tesla);
    ASSERT_TRUE(triad.ok());
    const double out = std::sqrt(2.0 * std::log(kReadings)) * kSigma_tesla / scene::kField_tesla;
    for (Eigen::Index axis = 0; axis < 3; ++axis) {
      EXPECT_NEAR(triad->offset(axis), hard_iron(axis), out * scene::kField_tesla);
      EXPECT_NEAR(triad->matrix(axis, axis) * gain(axis), 1.0, out);
    }
  }
}

TEST(NullAndScaleTest, MinMaxNamesTheAxisThatWasNotTurned) {
  std::vector<Eigen::Vector3d> ring;
  for (int i = 0; i < 100; ++i) {
    ring.push_back({40e-6 * std::cos(0.1 * i), 40e-6 * std::sin(0.1 * i), 10e-6});
  }
  EXPECT_EQ(MinMaxMag(ring, 0.0).error().message,
            "axis z spans less than half of the widest: point +z and -z along the field");
  EXPECT_FALSE(MinMaxMag(std::span(ring).first(5), 0.0).ok());
}

// Eq. (31): the error is that of the integral, n·√(T/2)/angle for a noise of density n plus
// δ·T/angle for a null that is off by δ. Four sigma over 50 seeds.
TEST(NullAndScaleTest, KnownRotationIsWithinTheErrorOfTheIntegral) {
  constexpr double kDt_s = 0.01;
  constexpr double kNoise_rad_s_rthz = 2e-4;
  constexpr int kReadings = 500;
  constexpr double kAngle_rad = 6.283185307179586;
  for (std::uint64_t seed = 1; seed <= 50; ++seed) {
    simulation::Random random(seed);
    const double gain = random.Uniform(0.9, 1.1);
    const double null = random.Uniform(-0.1, 0.1);
    const double sigma = kNoise_rad_s_rthz * std::sqrt(0.5 / kDt_s);
    std::vector<double> readings;
    std::vector<Eigen::Vector3d> rest;
    for (int i = 0; i < kReadings; ++i) {
      readings.push_back(gain * kAngle_rad / (kReadings * kDt_s) + null +
                         sigma * random.Gaussian());
      rest.emplace_back(null + sigma * random.Gaussian(), 0.0, 0.0);
    }
    const double null_found = GyroNull(rest).x();
    const double null_sigma = sigma / std::sqrt(kReadings);
    EXPECT_NEAR(null_found, null, 4.0 * null_sigma);
    const auto scale = GyroScaleFromKnownRotation(kAngle_rad, readings, null_found, kDt_s);
    ASSERT_TRUE(scale.ok());
    const double time_s = kReadings * kDt_s;
    const double expected =
        std::hypot(kNoise_rad_s_rthz * std::sqrt(time_s / 2.0), null_sigma * time_s) / kAngle_rad;
    EXPECT_NEAR(*scale * gain, 1.0, 4.0 * expected);
  }
}

TEST(NullAndScaleTest, ARotationThatTheGyroDidNotSeeIsRefused) {
  const std::vector<double> still(100, 0.0);
  EXPECT_FALSE(GyroScaleFromKnownRotation(3.14, still, 0.0, 0.01).ok());
  const std::vector<double> backwards(100, -3.14);
  EXPECT_FALSE(GyroScaleFromKnownRotation(3.14, backwards, 0.0, 0.01).ok());
}

}  // namespace
}  // namespace limbcast::sensing
