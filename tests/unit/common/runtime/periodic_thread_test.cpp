#include "common/runtime/periodic_thread.hpp"

#include <gtest/gtest.h>

#include <chrono>
#include <future>

#include "common/runtime/wake_event.hpp"

namespace limbcast::runtime {
namespace {

using namespace std::chrono_literals;

TEST(PeriodicThreadTest, TicksUntilStoppedAndNotAfter) {
  std::promise<void> third;
  int ticks = 0;  // plain: Stop joins, so reading it afterwards is no race
  PeriodicThread thread("ticker", 1ms, [&] {
    if (++ticks == 3) {
      third.set_value();
    }
  });
  third.get_future().wait();
  thread.Stop();
  const int at_stop = ticks;
  EXPECT_GE(at_stop, 3);
  EXPECT_EQ(thread.ticks(), static_cast<std::uint64_t>(at_stop));
  thread.Stop();
  EXPECT_EQ(ticks, at_stop);
}

TEST(PeriodicThreadTest, StopDoesNotWaitForALongPeriod) {
  const auto before = std::chrono::steady_clock::now();
  {
    const PeriodicThread thread("slow", 1h, [] {});
  }
  EXPECT_LT(std::chrono::steady_clock::now() - before, 1min);
}

TEST(PeriodicThreadTest, TicksCoveredByASlowOneAreLeftOutAndCounted) {
  std::promise<void> second;
  int ticks = 0;
  PeriodicThread thread("overrun", 1ms, [&] {
    if (++ticks == 1) {
      WakeEvent never;
      never.WaitFor(10ms);  // longer than several periods
    } else if (ticks == 2) {
      second.set_value();
    }
  });
  second.get_future().wait();
  thread.Stop();
  EXPECT_GE(thread.missed_ticks(), 8U);
}

}  // namespace
}  // namespace limbcast::runtime
