// Coils on people who walk past iron (tens of microtesla in half a metre): tracks get lost, but
// come back, and what is shown is mostly right.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>

#include "tests/support/position_run.hpp"

namespace limbcast {
namespace {

using test_support::CoilAid;
using test_support::CoilPeople;
using test_support::RunPositions;

TEST(CoilIronTest, TracksComeBackAndArePlacedWhereTheSensorIs) {
  double sum_m2 = 0.0;
  int count = 0;
  int expected = 0;
  for (const std::uint64_t seed : {101U, 102U, 103U, 104U, 105U, 106U}) {
    gateway::SimulatorConfig people = CoilPeople();
    people.iron = true;
    people.seed = seed;
    for (const auto& [key, figure] : RunPositions(people, CoilAid(), 60.0, 6.0)) {
      sum_m2 += figure.rms_m * figure.rms_m * figure.count;
      count += figure.count;
      expected += figure.expected;
    }
  }
  ASSERT_GT(count, 0);
  const double rms_m = std::sqrt(sum_m2 / count);
  const double there = static_cast<double>(count) / expected;
  std::printf("beside iron: %.0f mm RMS, there for %.0f %% of the time\n", 1e3 * rms_m,
              100.0 * there);
  // Without attention to the background, memory of the side and upright poses: 550 mm and a third.
  EXPECT_LT(rms_m, 0.2);
  EXPECT_GT(there, 0.55);
}

}  // namespace
}  // namespace limbcast
