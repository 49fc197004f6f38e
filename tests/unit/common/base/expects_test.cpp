#include "common/base/expects.hpp"

#include <gtest/gtest.h>

namespace limbcast {
namespace {

TEST(ExpectsTest, PassesWhenTheConditionHolds) { Expects(true, "the truth"); }

TEST(ExpectsDeathTest, AbortsNamingThePlaceAndWhatWasExpected) {
  EXPECT_DEATH(Expects(false, "a calibrated sensor"),
               "expects_test.cpp:[0-9]+: .*expected a calibrated sensor");
}

}  // namespace
}  // namespace limbcast
