#include "common/base/range.hpp"

#include <gtest/gtest.h>

#include <limits>

namespace limbcast {
namespace {

TEST(RangeTest, BothEndsAreInside) {
  EXPECT_TRUE(CheckRanges("coil: ", {{"low", 1.0, 1.0, 2.0}, {"high", 2.0, 1.0, 2.0}}).ok());
}

TEST(RangeTest, TheFirstOutsideIsNamedWithItsLimits) {
  const Status status =
      CheckRanges("coil: ", {{"a", 1.5, 1.0, 2.0}, {"b", 3.0, 1.0, 2.0}, {"c", 0.0, 1.0, 2.0}});
  ASSERT_FALSE(status.ok());
  EXPECT_EQ(status.error().code, ErrorCode::kInvalidArgument);
  EXPECT_EQ(status.error().message, "coil: b must be in [1.000000, 2.000000], is 3.000000");
}

TEST(RangeTest, WhatIsNoNumberIsOutside) {
  EXPECT_FALSE(CheckRanges("", {{"a", std::numeric_limits<double>::quiet_NaN(), 0.0, 1.0}}).ok());
}

}  // namespace
}  // namespace limbcast
