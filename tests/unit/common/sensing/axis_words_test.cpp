#include "common/sensing/axis_words.hpp"

#include <gtest/gtest.h>

namespace limbcast::sensing {
namespace {

TEST(AxisWordsTest, AnAxisIsItsName) {
  EXPECT_EQ(DirectionWords({2.0, 0.1, 0.0}), "+x");
  EXPECT_EQ(DirectionWords({0.0, 0.0, -3.0}), "-z");
}

TEST(AxisWordsTest, ADirectionBetweenAxesNamesAllOfThem) {
  EXPECT_EQ(DirectionWords({1.0, -1.0, 0.0}), "+x-y");
  EXPECT_EQ(DirectionWords({1.0, 1.0, 1.0}), "+x+y+z");
}

TEST(AxisWordsTest, NumbersHaveTheDecimalsAskedFor) {
  EXPECT_EQ(NumberText(12.345, 1), "12.3");
  EXPECT_EQ(NumberText(-0.5, 0), "-0");
  EXPECT_EQ(PercentText(0.734), "73 %");
  EXPECT_EQ(PercentText(0.0021, 2), "0.21 %");
}

}  // namespace
}  // namespace limbcast::sensing
