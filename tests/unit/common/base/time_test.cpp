#include "common/base/time.hpp"

#include <gtest/gtest.h>

namespace limbcast {
namespace {

using namespace std::chrono_literals;  // NOLINT: the literals are what the namespace is for

TEST(TimeTest, RoundTripsNanosecondsExactly) {
  constexpr std::int64_t kNow_ns = 1'700'000'000'123'456'789;
  static_assert(ToNanoseconds(TimeFromNanoseconds(kNow_ns)) == kNow_ns);
}

TEST(TimeTest, ConvertsSecondsToTheNearestNanosecond) {
  EXPECT_EQ(DurationFromSeconds(0.0035), Duration{3'500'000});
  EXPECT_EQ(DurationFromSeconds(-0.0035), Duration{-3'500'000});
  EXPECT_EQ(DurationFromSeconds(1e-9 * 0.6), Duration{1});
  EXPECT_DOUBLE_EQ(ToSeconds(1500ms), 1.5);
}

TEST(TimeTest, DifferencesAreDurations) {
  const Time start = TimeFromNanoseconds(10);
  EXPECT_EQ((start + 2ms) - start, Duration{2'000'000});
}

}  // namespace
}  // namespace limbcast
