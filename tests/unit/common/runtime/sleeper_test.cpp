#include "common/runtime/sleeper.hpp"

#include <gtest/gtest.h>

#include <chrono>
#include <thread>

#include "common/runtime/system_clock.hpp"

namespace limbcast::runtime {
namespace {

using namespace std::chrono_literals;

TEST(SleeperTest, SleepsToTheDeadlineAndNotShorter) {
  const SystemClock clock;
  Sleeper sleeper;
  const Time deadline = clock.Now() + 3ms;
  EXPECT_TRUE(sleeper.Until(deadline));
  EXPECT_GE(clock.Now(), deadline);
  EXPECT_TRUE(sleeper.Until(deadline)) << "a deadline in the past is reached already";
  EXPECT_TRUE(sleeper.For(1us));
}

TEST(SleeperTest, StopEndsASleepOfAnHour) {
  const SystemClock clock;
  Sleeper sleeper;
  std::thread stopper([&] { sleeper.Stop(); });
  EXPECT_FALSE(sleeper.Until(clock.Now() + 1h));
  stopper.join();
  EXPECT_TRUE(sleeper.stopped());
  EXPECT_FALSE(sleeper.For(1h));
}

}  // namespace
}  // namespace limbcast::runtime
