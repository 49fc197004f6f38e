// Two people with coils in one room, each in its own slot (design/position.md section 11).
#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <string>

#include "tests/support/position_run.hpp"

namespace limbcast {
namespace {

using test_support::CoilAid;
using test_support::CoilPeople;
using test_support::PositionFigures;
using test_support::RunPositions;

constexpr double kSeconds = 40.0;
constexpr double kFrom_s = 6.0;

// RMS over the four sensors of the first person.
double First_m(const PositionFigures& figures) {
  double sum_m2 = 0.0;
  int count = 0;
  for (const auto& [key, figure] : figures) {
    if (key.first == 1) {
      EXPECT_GT(figure.count, 0.95 * figure.expected) << body::ToString(key.second);
      sum_m2 += figure.rms_m * figure.rms_m;
      ++count;
    }
  }
  EXPECT_EQ(count, 4);
  return std::sqrt(sum_m2 / count);
}

TEST(CoilUsersTest, TwoPeopleWithSlotsAreAtMostATenthWorseThanOne) {
  // Both stand 1.5 m apart and then go side by side; the second one faces 40 degrees to the left.
  const double alone_m = First_m(RunPositions(CoilPeople(1), CoilAid(), kSeconds, kFrom_s));
  const double together_m = First_m(RunPositions(CoilPeople(2), CoilAid(), kSeconds, kFrom_s));
  RecordProperty("alone_mm", std::to_string(1e3 * alone_m));
  RecordProperty("together_mm", std::to_string(1e3 * together_m));
  std::printf("one person %.2f mm, two people with slots %.2f mm\n", 1e3 * alone_m,
              1e3 * together_m);
  EXPECT_LT(together_m, 1.1 * alone_m);
}

}  // namespace
}  // namespace limbcast
