#include "common/sensing/sphere_coverage.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numbers>

#include "common/simulation/random.hpp"

namespace limbcast::sensing {
namespace {

TEST(SphereCoverageTest, NothingSeenIsNothingCovered) {
  const SphereCoverage coverage;
  EXPECT_EQ(coverage.share(), 0.0);
  EXPECT_NEAR(coverage.widest_gap_rad(), std::numbers::pi, 1e-12);
}

TEST(SphereCoverageTest, OneDirectionCoversItsCap) {
  SphereCoverage coverage;
  coverage.Add({0.0, 0.0, 5.0});
  // Area of a cap of 30° over that of the sphere: (1 − cos 30°)/2 = 6.7 %.
  EXPECT_NEAR(coverage.share(), 0.067, 0.006);
  EXPECT_EQ(coverage.faces(), (std::array<bool, 6>{false, false, false, false, true, false}));
  EXPECT_LT(coverage.gap_direction().z(), -0.9);
}

TEST(SphereCoverageTest, ManyRandomDirectionsCoverAll) {
  simulation::Random random(11);
  SphereCoverage coverage;
  for (int i = 0; i < 200; ++i) {
    coverage.Add(random.Gaussian3());
  }
  EXPECT_EQ(coverage.share(), 1.0);
  EXPECT_EQ(coverage.MissingWords(), "");
}

TEST(SphereCoverageTest, TheEmptyHalfIsNamed) {
  simulation::Random random(12);
  SphereCoverage coverage;
  for (int i = 0; i < 500; ++i) {
    Eigen::Vector3d direction = random.Gaussian3();
    direction.z() = std::abs(direction.z());
    coverage.Add(direction);
  }
  EXPECT_EQ(coverage.MissingWords().substr(0, 2), "-z") << coverage.MissingWords();
  EXPECT_NEAR(coverage.share(), 0.75, 0.05) << "a hemisphere and 30° beyond: (1 + sin 30°)/2";
}

TEST(SphereCoverageTest, NothingOfWhatIsNotADirection) {
  SphereCoverage coverage;
  coverage.Add(Eigen::Vector3d::Zero());
  coverage.Add({std::numeric_limits<double>::quiet_NaN(), 0.0, 0.0});
  EXPECT_EQ(coverage.share(), 0.0);
}

TEST(SphereCoverageTest, ProbesAreUnitAndSumToNothing) {
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (const Eigen::Vector3d& probe : SphereCoverage::Probes()) {
    EXPECT_NEAR(probe.norm(), 1.0, 1e-12);
    sum += probe / static_cast<double>(SphereCoverage::kProbes);
  }
  EXPECT_LT(sum.norm(), 0.01);
}

}  // namespace
}  // namespace limbcast::sensing
