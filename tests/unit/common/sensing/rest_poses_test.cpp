#include "common/sensing/rest_poses.hpp"

#include <gtest/gtest.h>

#include "tests/unit/common/sensing/calibration_scene.hpp"

namespace limbcast::sensing {
namespace {

TEST(RestPosesTest, FindsEveryRestAndItsMeans) {
  const auto handling = scene::RandomPoses(10, 3);
  const auto errors = simulation::MakeMargErrors(simulation::NoisePreset::kIdeal);
  const auto samples = scene::Read(handling, errors, 3);
  const auto poses = FindRestPoses(samples);
  ASSERT_EQ(poses.size(), handling.poses.size());
  for (std::size_t i = 0; i < poses.size(); ++i) {
    const auto ideal = scene::IdealAt(handling.poses[i], Eigen::Vector3d::Zero());
    EXPECT_LT((poses[i].accel_m_s2 - ideal.accel_m_s2).norm(), 0.01);
    EXPECT_LT((poses[i].mag_tesla - ideal.mag_tesla).norm(), 1e-7);
    EXPECT_LT(poses[i].gyro_rad_s.norm(), 0.005);
    EXPECT_GE(poses[i].end - poses[i].begin, 150U);
    EXPECT_EQ(poses[i].mag_count, poses[i].end - poses[i].begin);
  }
}

TEST(RestPosesTest, ASteadySlowTurnIsNoRest) {
  auto samples = scene::Read(scene::RandomPoses(6, 4), scene::FactoryErrors(), 4);
  std::size_t still = FindRestPoses(samples).size();
  EXPECT_EQ(still, 6U);
  for (std::size_t i = 0; i < 200; ++i) {
    samples[i].gyro_rad_s.z() += 0.05F;  // about the vertical of its own: specific force stays
  }
  EXPECT_EQ(FindRestPoses(samples).size(), 5U);
}

TEST(RestPosesTest, SamplesWithoutAReadingAreNoRest) {
  auto samples = scene::Read(scene::RandomPoses(1, 5), scene::FactoryErrors(), 5);
  ASSERT_EQ(FindRestPoses(samples).size(), 1U);
  for (MargSample& sample : samples) {
    sample.flags |= kAccelMissing;
  }
  EXPECT_TRUE(FindRestPoses(samples).empty());
  EXPECT_TRUE(FindRestPoses({}).empty());
}

TEST(RestPosesTest, HeldMagnetometerReadingsAreNotCounted) {
  auto samples = scene::Read(scene::RandomPoses(1, 6), scene::FactoryErrors(), 6);
  for (std::size_t i = 0; i < samples.size(); ++i) {
    samples[i].flags |= i % 2 == 1 ? kMagHeld : 0U;
  }
  const auto poses = FindRestPoses(samples);
  ASSERT_EQ(poses.size(), 1U);
  EXPECT_EQ(poses[0].mag_count, samples.size() / 2);
}

}  // namespace
}  // namespace limbcast::sensing
