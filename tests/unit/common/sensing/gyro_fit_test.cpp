#include "common/sensing/gyro_fit.hpp"

#include <gtest/gtest.h>

#include <vector>

#include "tests/unit/common/sensing/calibration_scene.hpp"

namespace limbcast::sensing {
namespace {

struct Turns {
  std::vector<MargSample> samples;
  std::vector<CarriedDirection> carried;
};

// Without noise; directions are the true ones.
Turns MakeTurns(const Eigen::Matrix3d& gain, const Eigen::Vector3d& bias, std::uint64_t seed) {
  const auto handling = scene::RandomPoses(16, seed);
  Turns turns{.samples = scene::Read(handling, simulation::MargErrors{}, seed), .carried = {}};
  for (MargSample& sample : turns.samples) {
    sample.gyro_rad_s = (gain * sample.gyro_rad_s.cast<double>() + bias).cast<float>();
  }
  for (std::size_t i = 0; i + 1 < handling.poses.size(); ++i) {
    const auto up = [&](std::size_t pose) {
      return Eigen::Vector3d(handling.poses[pose].conjugate() * Eigen::Vector3d::UnitZ());
    };
    turns.carried.push_back({.begin = i * 350 + 100,
                             .end = i * 350 + 450,
                             .before = up(i),
                             .after = up(i + 1),
                             .null_before_rad_s = bias,
                             .null_after_rad_s = bias});
  }
  return turns;
}

TEST(GyroFitTest, WithoutNoiseItInvertsTheGain) {
  for (std::uint64_t seed = 1; seed <= 10; ++seed) {
    simulation::Random random(seed);
    Eigen::Matrix3d gain = Eigen::Matrix3d::Identity();
    for (double& element : gain.reshaped()) {
      element += random.Uniform(-0.05, 0.05);
    }
    const Turns turns = MakeTurns(gain, random.Uniform3(0.05), seed);
    const auto fit = FitGyro(turns.samples, turns.carried, {});
    ASSERT_TRUE(fit.ok()) << fit.error().message;
    // The mean of two readings stands for the rate between them: O(dt²).
    EXPECT_LT((fit->calibration.matrix * gain - Eigen::Matrix3d::Identity()).norm(), 1e-4) << seed;
    EXPECT_LT(fit->residual_after, 1e-4);
    EXPECT_GT(fit->residual_before, 0.01);
  }
}

TEST(GyroFitTest, AnAxisThatWasNotTurnedIsNamed) {
  Turns turns = MakeTurns(Eigen::Matrix3d::Identity(), Eigen::Vector3d::Zero(), 1);
  for (MargSample& sample : turns.samples) {
    sample.gyro_rad_s.y() = 0.0F;
  }
  const auto fit = FitGyro(turns.samples, turns.carried, {});
  ASSERT_FALSE(fit.ok());
  EXPECT_EQ(fit.error().message, "turn more about axis y (0 of 360 deg)");
}

TEST(GyroFitTest, FewTurnsAreRefused) {
  const Turns turns = MakeTurns(Eigen::Matrix3d::Identity(), Eigen::Vector3d::Zero(), 2);
  const auto fit = FitGyro(turns.samples, std::span(turns.carried).first(5), {});
  ASSERT_FALSE(fit.ok());
  EXPECT_EQ(fit.error().message,
            "turns from one pose at rest to another must be at least 6, are 5");
}

TEST(GyroFitTest, ContradictingDirectionsAreRefused) {
  Turns turns = MakeTurns(Eigen::Matrix3d::Identity(), Eigen::Vector3d::Zero(), 3);
  simulation::Random random(3);
  for (CarriedDirection& span : turns.carried) {
    span.after = (span.after + 0.2 * random.Gaussian3()).normalized();
  }
  EXPECT_FALSE(FitGyro(turns.samples, turns.carried, {}).ok());
  EXPECT_FALSE(
      FitGyro(turns.samples, turns.carried, {.max_sigma = 1.0, .max_residual_rad = 0.01}).ok());
}

}  // namespace
}  // namespace limbcast::sensing
