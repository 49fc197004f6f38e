#include "common/sensing/triad_alignment.hpp"

#include <gtest/gtest.h>

#include <vector>

#include "common/math/rotation.hpp"
#include "tests/unit/common/sensing/calibration_scene.hpp"

namespace limbcast::sensing {
namespace {

std::vector<GravityAndField> Seen(const Eigen::Matrix3d& R_mag_accel, double sigma,
                                  std::uint64_t seed) {
  simulation::Random random(seed);
  std::vector<GravityAndField> seen;
  for (const auto& q : scene::RandomPoses(20, seed).poses) {
    const auto ideal = scene::IdealAt(q, Eigen::Vector3d::Zero());
    seen.push_back({.accel_m_s2 = ideal.accel_m_s2,
                    .mag_tesla = R_mag_accel * ideal.mag_tesla +
                                 sigma * scene::kField_tesla * random.Gaussian3()});
  }
  return seen;
}

TEST(TriadAlignmentTest, FindsTheTurnOfTheMagnetometerAndTheDip) {
  for (std::uint64_t seed = 1; seed <= 30; ++seed) {
    simulation::Random random(seed);
    const Eigen::Matrix3d R = math::ExpSO3(random.Uniform3(0.3)).toRotationMatrix();
    const auto found = AlignMagToAccel(Seen(R, 0.0, seed), 0.01);
    ASSERT_TRUE(found.ok()) << found.error().message;
    EXPECT_LT((found->R_accel_mag * R - Eigen::Matrix3d::Identity()).norm(), 1e-6) << seed;
    EXPECT_NEAR(found->dip_rad, scene::kDip_rad, 1e-6);
    EXPECT_LT(found->residual_after, 1e-7);
  }
}

TEST(TriadAlignmentTest, NoiseBeyondTheLimitIsRefused) {
  const auto found = AlignMagToAccel(Seen(Eigen::Matrix3d::Identity(), 0.1, 1), 0.005);
  ASSERT_FALSE(found.ok());
  EXPECT_NE(found.error().message.find("hold more different poses"), std::string::npos);
  EXPECT_FALSE(AlignMagToAccel({}, 0.005).ok());
}

TEST(TriadAlignmentTest, SixLevelPositionsGiveTheCase) {
  const Eigen::Matrix3d R_accel_case =
      math::ExpSO3(Eigen::Vector3d(0.03, -0.02, 0.05)).toRotationMatrix();
  std::vector<Eigen::Vector3d> seen;
  for (const auto& q : scene::SixFaces(0.4, 0.0, 1).poses) {
    seen.push_back(R_accel_case * scene::IdealAt(q, Eigen::Vector3d::Zero()).accel_m_s2);
  }
  const auto R_case_accel = AlignToCase(seen);
  ASSERT_TRUE(R_case_accel.ok());
  EXPECT_LT((*R_case_accel * R_accel_case - Eigen::Matrix3d::Identity()).norm(), 1e-9);
  seen.pop_back();
  EXPECT_EQ(AlignToCase(seen).error().message,
            "positions missing: lay the case on a level surface with -z up");
}

}  // namespace
}  // namespace limbcast::sensing
