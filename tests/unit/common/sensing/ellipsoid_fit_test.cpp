#include "common/sensing/ellipsoid_fit.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "tests/unit/common/sensing/calibration_scene.hpp"

namespace limbcast::sensing {
namespace {

struct Cloud {
  Eigen::Matrix3d gain;
  Eigen::Vector3d bias;
  std::vector<Eigen::Vector3d> readings;
};

Cloud MakeCloud(std::uint64_t seed, int count, double norm, double sigma, double lowest_z = -1.0) {
  simulation::Random random(seed);
  Cloud cloud{.gain = Eigen::Matrix3d::Identity(), .bias = random.Uniform3(norm), .readings = {}};
  for (double& element : cloud.gain.reshaped()) {
    element += random.Uniform(-0.1, 0.1);
  }
  while (cloud.readings.size() < static_cast<std::size_t>(count)) {
    const Eigen::Vector3d u = random.Rotation() * Eigen::Vector3d::UnitX();
    if (u.z() >= lowest_z) {
      cloud.readings.push_back(cloud.gain * (norm * u) + cloud.bias + sigma * random.Gaussian3());
    }
  }
  return cloud;
}

TEST(EllipsoidFitTest, WithoutNoiseItIsExactUpToARotation) {
  for (std::uint64_t seed = 1; seed <= 30; ++seed) {
    const Cloud cloud = MakeCloud(seed, 60, 9.8, 0.0);
    const auto fit = FitEllipsoid(cloud.readings, {.norm = 9.8}, " up");
    ASSERT_TRUE(fit.ok()) << fit.error().message;
    const Eigen::Matrix3d E = fit->calibration.matrix * cloud.gain;
    EXPECT_LT((E.transpose() * E - Eigen::Matrix3d::Identity()).norm(), 1e-8) << seed;
    EXPECT_LT((fit->calibration.offset - cloud.bias).norm(), 1e-8) << seed;
    EXPECT_LT(fit->residual_after, 1e-9);
    EXPECT_GT(fit->residual_before, 0.05);
  }
}

// The reported 1-sigma is that of the errors over many draws: their RMS is between half and 1.5 of
// it (the least certain element is reported, so it is rather above).
TEST(EllipsoidFitTest, ReportsItsOwnUncertainty) {
  double sum = 0.0;
  double reported = 0.0;
  constexpr int kTrials = 100;
  const Cloud cloud = MakeCloud(77, 200, 1.0, 0.0);
  for (int trial = 0; trial < kTrials; ++trial) {
    simulation::Random random(1000 + static_cast<std::uint64_t>(trial));
    auto readings = cloud.readings;
    for (Eigen::Vector3d& reading : readings) {
      reading += 0.005 * random.Gaussian3();
    }
    const auto fit = FitEllipsoid(readings, {.norm = 1.0}, "");
    ASSERT_TRUE(fit.ok());
    sum += (fit->calibration.offset - cloud.bias).squaredNorm() / 3.0;
    reported += fit->sigma_offset / kTrials;
  }
  const double rms = std::sqrt(sum / kTrials);
  EXPECT_GT(rms, 0.5 * reported);
  EXPECT_LT(rms, 1.5 * reported);
}

TEST(EllipsoidFitTest, WithoutAKnownNormTheOverallScaleStays) {
  const Cloud cloud = MakeCloud(5, 500, 48e-6, 0.2e-6);
  const auto fit = FitEllipsoid(cloud.readings, {}, "");
  ASSERT_TRUE(fit.ok());
  EXPECT_NEAR(fit->calibration.matrix.determinant(), 1.0, 1e-9);
  EXPECT_LT((fit->calibration.offset - cloud.bias).norm(), 0.01 * 48e-6);
}

TEST(EllipsoidFitTest, OutliersDoNotPull) {
  Cloud cloud = MakeCloud(6, 400, 1.0, 0.002);
  for (std::size_t i = 0; i < cloud.readings.size(); i += 20) {
    cloud.readings[i] += Eigen::Vector3d(0.3, 0.0, 0.0);
  }
  const auto fit = FitEllipsoid(cloud.readings, {.norm = 1.0, .max_residual = 0.1}, "");
  ASSERT_TRUE(fit.ok()) << fit.error().message;
  EXPECT_LT((fit->calibration.offset - cloud.bias).norm(), 0.01);
}

TEST(EllipsoidFitTest, AHalfSphereIsRefusedWithTheMissingHalf) {
  const Cloud cloud = MakeCloud(7, 500, 9.8, 0.01, 0.3);
  const auto fit = FitEllipsoid(cloud.readings, {.norm = 9.8}, " up");
  ASSERT_FALSE(fit.ok());
  EXPECT_NE(fit.error().message.find("missing -z"), std::string::npos) << fit.error().message;
  EXPECT_NE(fit.error().message.find(" up"), std::string::npos);
}

TEST(EllipsoidFitTest, ARingIsRefusedWithItsAxis) {
  simulation::Random random(8);
  std::vector<Eigen::Vector3d> ring;
  for (int i = 0; i < 400; ++i) {
    ring.push_back(Eigen::Vector3d(std::cos(0.1 * i), std::sin(0.1 * i), 0.2) +
                   0.003 * random.Gaussian3());
  }
  const auto fit = FitEllipsoid(ring, {}, " along the field");
  ASSERT_FALSE(fit.ok());
  EXPECT_NE(fit.error().message.find("z"), std::string::npos) << fit.error().message;
  EXPECT_NE(fit.error().message.find("turn the sensor until"), std::string::npos)
      << fit.error().message;
}

TEST(EllipsoidFitTest, AFieldThatChangesIsRefused) {
  Cloud cloud = MakeCloud(9, 400, 1.0, 0.0);
  simulation::Random random(9);
  for (Eigen::Vector3d& reading : cloud.readings) {
    reading *= random.Uniform(0.7, 1.3);
  }
  const auto fit = FitEllipsoid(cloud.readings, {.norm = 1.0, .max_sigma = 0.1}, "");
  ASSERT_FALSE(fit.ok());
  EXPECT_NE(fit.error().message.find("still varies"), std::string::npos) << fit.error().message;
}

TEST(EllipsoidFitTest, TooFewReadingsAreRefused) {
  const Cloud cloud = MakeCloud(10, 11, 1.0, 0.0);
  EXPECT_EQ(FitEllipsoid(cloud.readings, {}, "").error().message,
            "different positions must be at least 12, are 11");
}

}  // namespace
}  // namespace limbcast::sensing
