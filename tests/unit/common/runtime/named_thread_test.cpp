#include "common/runtime/named_thread.hpp"

#include <gtest/gtest.h>
#include <pthread.h>

#include <array>
#include <atomic>
#include <csignal>
#include <string>
#include <utility>

namespace limbcast::runtime {
namespace {

std::string NameOfThisThread() {
  std::array<char, 32> name{};
  pthread_getname_np(pthread_self(), name.data(), name.size());
  return name.data();
}

TEST(NamedThreadTest, CarriesItsNameUpToFifteenCharacters) {
  std::string short_name;
  std::string long_name;
  {
    const NamedThread a("fusion-0", [&] { short_name = NameOfThisThread(); });
    const NamedThread b("a-name-that-is-too-long", [&] { long_name = NameOfThisThread(); });
  }
  EXPECT_EQ(short_name, "fusion-0");
  EXPECT_EQ(long_name, "a-name-that-is-");
}

TEST(NamedThreadTest, LeavesStopSignalsToOtherThreadsAndTheMaskOfItsMakerAlone) {
  sigset_t of_thread;
  sigemptyset(&of_thread);
  sigset_t before;
  sigset_t after;
  pthread_sigmask(SIG_SETMASK, nullptr, &before);
  {
    const NamedThread thread("masked", [&] { pthread_sigmask(SIG_SETMASK, nullptr, &of_thread); });
  }
  pthread_sigmask(SIG_SETMASK, nullptr, &after);
  EXPECT_EQ(sigismember(&of_thread, SIGINT), 1);
  EXPECT_EQ(sigismember(&of_thread, SIGTERM), 1);
  EXPECT_EQ(sigismember(&before, SIGTERM), sigismember(&after, SIGTERM));
}

TEST(NamedThreadTest, AssignmentJoinsTheThreadItReplaces) {
  std::atomic<int> ended{0};
  NamedThread thread("first", [&] { ++ended; });
  thread = NamedThread();
  EXPECT_EQ(ended, 1);
  EXPECT_FALSE(thread.joinable());
  thread.Join();  // again: does nothing
}

}  // namespace
}  // namespace limbcast::runtime
