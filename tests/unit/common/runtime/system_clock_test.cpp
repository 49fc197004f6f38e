#include "common/runtime/system_clock.hpp"

#include <gtest/gtest.h>

#include <chrono>

namespace limbcast::runtime {
namespace {

TEST(SystemClockTest, TellsTheUnixTimeOfTheHost) {
  const SystemClock clock;
  const auto unix_ns = [] {
    return std::chrono::duration_cast<std::chrono::nanoseconds>(
               std::chrono::system_clock::now().time_since_epoch())
        .count();
  };
  const std::int64_t before = unix_ns();
  const std::int64_t now = ToNanoseconds(clock.Now());
  const std::int64_t after = unix_ns();
  EXPECT_LE(before, now);
  EXPECT_LE(now, after);
}

}  // namespace
}  // namespace limbcast::runtime
