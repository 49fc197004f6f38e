#include "common/runtime/host_usage.hpp"

#include <gtest/gtest.h>

#include <ctime>

#include "common/runtime/process_usage.hpp"

namespace limbcast::runtime {
namespace {

TEST(HostUsageTest, IdleAndWaitingAreNotBusyAndStolenTimeIsApart) {
  const auto usage =
      ParseHostUsage("cpu  100 20 300 5000 600 7 8 90 11 12\ncpu0 1 2 3 4 5 6 7 8 9 10\n", 100.0);
  ASSERT_TRUE(usage.ok());
  EXPECT_DOUBLE_EQ(usage->busy_seconds, 4.35);
  EXPECT_DOUBLE_EQ(usage->stolen_seconds, 0.9);
}

TEST(HostUsageTest, OtherTextIsRefusedWithWhatItSays) {
  for (const char* text : {"", "cpu", "cpu 1 2 3", "intr 1 2 3 4 5 6 7 8", "cpu a b c d e f g h"}) {
    const auto usage = ParseHostUsage(text, 100.0);
    ASSERT_FALSE(usage.ok()) << text;
    EXPECT_EQ(usage.error().code, ErrorCode::kCorruptData);
    EXPECT_NE(usage.error().message.find(text), std::string::npos);
  }
}

TEST(HostUsageTest, TheHostIsBusyAtLeastAsLongAsThisProcess) {
  const HostUsage before = ReadHostUsage();
  const double ours_before_s = ReadProcessUsage().cpu_seconds;
  double ours_s = 0.0;
  while (ours_s < 0.2) {
    ours_s = ReadProcessUsage().cpu_seconds - ours_before_s;
  }
  const double kTick_s = 0.02;  // the kernel counts whole ticks on each core
  EXPECT_GE((ReadHostUsage() - before).busy_seconds, ours_s - 2.0 * kTick_s);
}

}  // namespace
}  // namespace limbcast::runtime
