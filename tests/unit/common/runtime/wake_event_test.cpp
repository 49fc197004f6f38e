#include "common/runtime/wake_event.hpp"

#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <thread>

#include "common/runtime/system_clock.hpp"

namespace limbcast::runtime {
namespace {

using namespace std::chrono_literals;

TEST(WakeEventTest, SetBeforeTheWaitEndsItAtOnceAndOnlyOnce) {
  WakeEvent event;
  event.Set();
  event.Set();
  EXPECT_TRUE(event.pending());
  EXPECT_TRUE(event.WaitUntil(std::nullopt));
  EXPECT_FALSE(event.pending());
  EXPECT_FALSE(event.WaitFor(1us));
}

TEST(WakeEventTest, WaitReturnsFalseWhenItsDeadlineIsPast) {
  WakeEvent event;
  const SystemClock clock;
  EXPECT_FALSE(event.WaitUntil(clock.Now() - 1s));
  EXPECT_FALSE(event.WaitUntil(Time{} - 1s));
  const Time deadline = clock.Now() + 2ms;
  EXPECT_FALSE(event.WaitUntil(deadline));
  EXPECT_GE(clock.Now(), deadline);
}

TEST(WakeEventTest, CloseEndsAllWaitsForGood) {
  WakeEvent event;
  event.Close();
  event.Set();
  EXPECT_TRUE(event.closed());
  EXPECT_TRUE(event.WaitUntil(std::nullopt));
  EXPECT_TRUE(event.WaitFor(1h));
}

TEST(WakeEventTest, CloseEndsTheWaitOfAnotherThread) {
  WakeEvent event;
  std::thread waiter([&] { EXPECT_TRUE(event.WaitUntil(std::nullopt)); });
  event.Close();
  waiter.join();
}

// Two threads hand a plain (not atomic) number back and forth: a lost wake-up hangs, a missing
// ordering is seen by the thread sanitizer.
TEST(WakeEventTest, NoWakeUpIsLostAndWhatWasWrittenBeforeIsSeen) {
  constexpr int kRounds = 20'000;
  WakeEvent there;
  WakeEvent back;
  int ball = 0;
  std::thread other([&] {
    for (int i = 0; i < kRounds; ++i) {
      there.WaitUntil(std::nullopt);
      ++ball;
      back.Set();
    }
  });
  for (int i = 0; i < kRounds; ++i) {
    ASSERT_EQ(ball, i);
    there.Set();
    back.WaitUntil(std::nullopt);
  }
  other.join();
  EXPECT_EQ(ball, kRounds);
}

TEST(WakeEventTest, ManySettersWakeOneWaiterForEverythingTheyCounted) {
  constexpr int kSetters = 4;
  constexpr int kEach = 5'000;
  WakeEvent event;
  std::atomic<int> queued{0};
  std::vector<std::thread> setters;
  for (int s = 0; s < kSetters; ++s) {
    setters.emplace_back([&] {
      for (int i = 0; i < kEach; ++i) {
        queued.fetch_add(1, std::memory_order_relaxed);
        event.Set();
      }
    });
  }
  int taken = 0;
  while (taken < kSetters * kEach) {
    event.WaitUntil(std::nullopt);  // hangs here if a wake-up is lost
    taken += queued.exchange(0, std::memory_order_relaxed);
  }
  for (std::thread& setter : setters) {
    setter.join();
  }
  EXPECT_EQ(taken, kSetters * kEach);
}

}  // namespace
}  // namespace limbcast::runtime
