#include "common/runtime/process_usage.hpp"

#include <gtest/gtest.h>

#include <vector>

#include "common/runtime/named_thread.hpp"
#include "common/runtime/wake_event.hpp"

namespace limbcast::runtime {
namespace {

TEST(ProcessUsageTest, MemoryThatIsTouchedShowsUp) {
  const ProcessUsage before = ReadProcessUsage();
  std::vector<char> block(64U << 20U, 1);
  const ProcessUsage after = ReadProcessUsage();
  EXPECT_GT(before.rss_mib, 1.0);
  EXPECT_GT(after.rss_mib - before.rss_mib, 50.0) << block.back();
}

TEST(ProcessUsageTest, ProcessorTimeGrowsWithWork) {
  const double before = ReadProcessUsage().cpu_seconds;
  volatile double sink = 0.0;
  double used = 0.0;
  for (std::uint64_t rounds = 0; used < 0.02 && rounds < 100'000; ++rounds) {
    for (int i = 0; i < 100'000; ++i) {
      sink = sink + 1.0;
    }
    used = ReadProcessUsage().cpu_seconds - before;
  }
  EXPECT_GE(used, 0.02);
}

TEST(ProcessUsageTest, AThreadMoreIsAThreadMore) {
  WakeEvent first_end;  // an event is waited for by one thread only
  WakeEvent end;
  // The first one may bring company: the thread sanitizer's own.
  const NamedThread first("first", [&] { first_end.WaitUntil(std::nullopt); });
  const std::uint32_t before = ReadProcessUsage().threads;
  const NamedThread thread("extra", [&] { end.WaitUntil(std::nullopt); });
  EXPECT_EQ(ReadProcessUsage().threads, before + 1);
  first_end.Close();
  end.Close();
}

}  // namespace
}  // namespace limbcast::runtime
