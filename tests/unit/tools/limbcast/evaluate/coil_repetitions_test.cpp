#include "tools/limbcast/evaluate/coil_repetitions.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <mutex>
#include <vector>

namespace limbcast::tool {
namespace {

constexpr auto kForward = static_cast<std::size_t>(CoilMethod::kForward);

CoilResult One(double position_m, int losses) {
  CoilResult result;
  result.experiment = "bench";
  result.figures[kForward] = {
      .count = 10, .position_m = position_m, .distance_m = 0.001, .orientation_rad = 0.01};
  result.mean_range_m = 0.4;
  result.forward = {.tracked = 1.0, .losses = losses, .nees = 0.5};
  return result;
}

TEST(CoilRepetitionsTest, MeansAndDeviationsAreThoseOfTheRepetitions) {
  const std::vector<CoilResult> three = {One(0.010, 0), One(0.012, 1), One(0.017, 2)};
  const CoilResult mean = MeanOf(three);
  EXPECT_EQ(mean.experiment, "bench");
  EXPECT_EQ(mean.repetitions, 3);
  EXPECT_NEAR(mean.figures[kForward].position_m, 0.013, 1e-12);
  EXPECT_NEAR(mean.deviations[kForward].position_m, std::sqrt(13.0) * 1e-3, 1e-12);
  EXPECT_NEAR(mean.deviations[kForward].distance_m, 0.0, 1e-12);
  EXPECT_EQ(mean.forward.losses, 3);
  EXPECT_NEAR(mean.forward.tracked, 1.0, 1e-12);
  EXPECT_NEAR(mean.mean_range_m, 0.4, 1e-12);
  EXPECT_EQ(MeanOf(std::span(three).first(1)).deviations[kForward].position_m, 0.0);
}

TEST(CoilRepetitionsTest, EachRepetitionIsDrawnAnewAndAllOfThemAgainFromTheSameSeed) {
  std::size_t calls = 0;
  std::size_t last = 0;
  const auto twice =
      RepeatCoilExperiments("back rotation", 5, 2, [&](std::size_t done, std::size_t all) {
        ++calls;
        last = done;
        EXPECT_EQ(all, 4U);
      });
  EXPECT_EQ(calls, 4U);
  EXPECT_EQ(last, 4U);
  ASSERT_EQ(twice.size(), 2U) << "one for each noise";
  EXPECT_EQ(twice[0].noise, CoilNoise::kThesis);
  EXPECT_EQ(twice[1].noise, CoilNoise::kModern);
  EXPECT_GT(twice[0].deviations[kForward].position_m, 0.0);
  const auto once = RepeatCoilExperiments("back rotation", 5, 1);
  const auto again = RepeatCoilExperiments("back rotation", 5, 1);
  EXPECT_EQ(once[0].figures[kForward].position_m, again[0].figures[kForward].position_m);
  EXPECT_NE(once[0].figures[kForward].position_m, twice[0].figures[kForward].position_m);
  EXPECT_TRUE(RepeatCoilExperiments("no such experiment", 5, 1).empty());
}

}  // namespace
}  // namespace limbcast::tool
