#include "services/posture/confidence.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace limbcast::posture {
namespace {

using namespace std::chrono_literals;

TEST(ConfidenceTest, IsOneForAPerfectMeasurement) { EXPECT_FLOAT_EQ(Confidence({}), 1.0F); }

TEST(ConfidenceTest, HalvesAtTheReferenceSigmaAndDecaysWithAge) {
  EXPECT_FLOAT_EQ(Confidence({.sigma_rad = 0.2F}), 0.5F);
  EXPECT_NEAR(Confidence({.age = 1s}), std::exp(-1.0), 1e-6);
}

TEST(ConfidenceTest, EveryBlemishLowersIt) {
  const float clean = Confidence({.sigma_rad = 0.05F});
  EXPECT_LT(Confidence({.sigma_rad = 0.05F, .aligned = false}), clean);
  EXPECT_LT(Confidence({.sigma_rad = 0.05F, .degraded = true}), clean);
  EXPECT_LT(Confidence({.sigma_rad = 0.05F, .disturbed = true}), clean);
  EXPECT_LT(Confidence({.sigma_rad = 0.06F}), clean);
}

TEST(ConfidenceTest, ItGrowsWithTheQualityOfTheAlignmentFromThatOfNone) {
  const float none = Confidence({.aligned = false});
  EXPECT_FLOAT_EQ(Confidence({.alignment_quality = 0.0F}), none);
  EXPECT_FLOAT_EQ(Confidence({.alignment_quality = 0.5F}), 0.75F);
  EXPECT_FLOAT_EQ(Confidence({.alignment_quality = 1.0F}), 1.0F);
  EXPECT_FLOAT_EQ(Confidence({.aligned = false, .alignment_quality = 1.0F}), none);
  EXPECT_FLOAT_EQ(Confidence({.alignment_quality = 7.0F}), 1.0F);
  EXPECT_FLOAT_EQ(Confidence({.alignment_quality = std::numeric_limits<float>::quiet_NaN()}), 0.0F);
}

TEST(ConfidenceTest, AnUnknownSigmaIsAGuess) {
  EXPECT_FLOAT_EQ(Confidence({.sigma_rad = std::numeric_limits<float>::quiet_NaN()}), 0.0F);
  EXPECT_FLOAT_EQ(Confidence({.sigma_rad = std::numeric_limits<float>::infinity()}), 0.0F);
}

TEST(ConfidenceTest, SigmaIsTheRootOfTheTrace) {
  Eigen::Matrix3f cov = Eigen::Vector3f(0.01F, 0.02F, 0.06F).asDiagonal();
  EXPECT_NEAR(SigmaOf(cov), 0.3F, 1e-6F);
  cov(0, 0) = std::numeric_limits<float>::quiet_NaN();
  EXPECT_TRUE(std::isnan(SigmaOf(cov)));
}

}  // namespace
}  // namespace limbcast::posture
