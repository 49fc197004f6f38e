#include "common/runtime/thread_pool.hpp"

#include <gtest/gtest.h>

#include <array>
#include <atomic>
#include <chrono>
#include <future>
#include <thread>

#include "common/runtime/system_clock.hpp"

namespace limbcast::runtime {
namespace {

using namespace std::chrono_literals;

TEST(ThreadPoolTest, EveryWorkerDrainsOnceAtTheStartAndOnceAtTheEnd) {
  std::array<std::atomic<int>, 3> drains{};
  ThreadPool pool("pool", drains.size());
  EXPECT_EQ(pool.size(), 3U);
  pool.Start([&](std::size_t worker) -> std::optional<Time> {
    ++drains[worker];
    return std::nullopt;
  });
  pool.Stop();
  for (const auto& count : drains) {
    EXPECT_GE(count, 1);
    EXPECT_LE(count, 2);
  }
}

TEST(ThreadPoolTest, WorkQueuedBeforeStopIsDone) {
  std::atomic<int> queued{0};
  std::atomic<int> done{0};
  ThreadPool pool("pool", 1);
  pool.Start([&](std::size_t) -> std::optional<Time> {
    done += queued.exchange(0);
    return std::nullopt;
  });
  for (int i = 0; i < 100; ++i) {
    ++queued;
    pool.Wake(0);
  }
  pool.Stop();
  EXPECT_EQ(done, 100);
}

TEST(ThreadPoolTest, WakeBeforeStartIsRemembered) {
  std::promise<void> twice;
  std::atomic<int> drains{0};
  ThreadPool pool("pool", 1);
  pool.Wake(0);
  pool.Start([&](std::size_t) -> std::optional<Time> {
    if (++drains == 2) {
      twice.set_value();
    }
    return std::nullopt;
  });
  twice.get_future().wait();
}

TEST(ThreadPoolTest, ADrainIsCalledAgainAtTheTimeItWishedWithoutAWake) {
  const SystemClock clock;
  std::promise<Time> second_call;
  Time wished{};
  int calls = 0;
  ThreadPool pool("pool", 1);
  pool.Start([&](std::size_t) -> std::optional<Time> {
    if (++calls == 1) {
      wished = clock.Now() + 2ms;
      return wished;
    }
    if (calls == 2) {
      second_call.set_value(clock.Now());
    }
    return std::nullopt;
  });
  EXPECT_GE(second_call.get_future().get(), wished);
}

// Producers on several threads, plain data behind the atomic queue length: under the thread
// sanitizer this shows that a drain sees what was written before Wake and never runs twice at once.
TEST(ThreadPoolTest, NoWakeIsLostUnderManyProducers) {
  constexpr int kProducers = 3;
  constexpr int kEach = 3'000;
  for (const Duration spin : {Duration{0}, Duration{20us}}) {
    std::array<std::atomic<int>, 2> queued{};
    std::array<int, 2> done{};  // plain: only its worker writes, Stop joins
    std::promise<void> all_done;
    std::atomic<int> left{kProducers * kEach};
    ThreadPool pool(ThreadPoolConfig{"pool", 2, spin});
    pool.Start([&](std::size_t worker) -> std::optional<Time> {
      const int taken = queued[worker].exchange(0);
      done[worker] += taken;
      if (taken > 0 && left.fetch_sub(taken) == taken) {
        all_done.set_value();
      }
      return std::nullopt;
    });
    std::vector<std::thread> producers;
    for (int p = 0; p < kProducers; ++p) {
      producers.emplace_back([&] {
        for (int i = 0; i < kEach; ++i) {
          const auto worker = static_cast<std::size_t>(i % 2);
          ++queued[worker];
          pool.Wake(worker);
        }
      });
    }
    all_done.get_future().wait();  // hangs here if a wake is lost
    for (std::thread& producer : producers) {
      producer.join();
    }
    pool.Stop();
    EXPECT_EQ(done[0] + done[1], kProducers * kEach);
  }
}

TEST(ThreadPoolDeathTest, ASecondStartIsOurMistake) {
  GTEST_FLAG_SET(death_test_style, "threadsafe");
  EXPECT_DEATH(
      {
        ThreadPool pool("pool", 1);
        pool.Start([](std::size_t) { return std::optional<Time>(); });
        pool.Start([](std::size_t) { return std::optional<Time>(); });
      },
      "started once");
}

}  // namespace
}  // namespace limbcast::runtime
