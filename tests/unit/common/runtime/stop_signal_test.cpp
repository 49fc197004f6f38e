#include "common/runtime/stop_signal.hpp"

#include <gtest/gtest.h>
#include <unistd.h>

#include <chrono>
#include <csignal>
#include <thread>
#include <vector>

namespace limbcast::runtime {
namespace {

using namespace std::chrono_literals;

TEST(StopSignalTest, IsNotRequestedBeforeAnythingHappens) {
  const StopSignal stop;
  EXPECT_FALSE(stop.Requested());
  EXPECT_FALSE(stop.WaitFor(1us));
}

TEST(StopSignalTest, SignalsOfTheTerminalAndOfTheServiceManagerAreRequests) {
  for (const int signal : {SIGINT, SIGTERM}) {
    const StopSignal stop;
    ASSERT_EQ(kill(getpid(), signal), 0);  // to the process, as a shell does
    stop.Wait();
    EXPECT_TRUE(stop.Requested());
    EXPECT_TRUE(stop.WaitFor(1h));
  }
}

TEST(StopSignalTest, AnOldRequestDoesNotStopTheNextOne) {
  {
    StopSignal stop;
    stop.Trigger();
    EXPECT_TRUE(stop.Requested());
  }
  const StopSignal next;
  EXPECT_FALSE(next.Requested());
}

TEST(StopSignalTest, TriggerEndsTheWaitOfEveryThread) {
  StopSignal stop;
  std::vector<std::thread> waiters;
  waiters.emplace_back([&] { stop.Wait(); });
  waiters.emplace_back([&] { stop.Wait(); });
  waiters.emplace_back([&] { EXPECT_TRUE(stop.WaitFor(1h)); });
  stop.Trigger();
  for (std::thread& waiter : waiters) {
    waiter.join();
  }
}

TEST(StopSignalTest, GivesBackTheHandlersItFound) {
  struct sigaction before {};
  sigaction(SIGTERM, nullptr, &before);
  { const StopSignal stop; }
  struct sigaction after {};
  sigaction(SIGTERM, nullptr, &after);
  EXPECT_EQ(before.sa_handler, after.sa_handler);
}

}  // namespace
}  // namespace limbcast::runtime
