#include "common/runtime/bounded_queue.hpp"

#include <gtest/gtest.h>

#include <array>
#include <memory>
#include <thread>
#include <vector>

namespace limbcast::runtime {
namespace {

TEST(BoundedQueueTest, GivesBackWhatWasPushedInOrderAroundTheRing) {
  BoundedQueue<int> queue(4);
  int value = 0;
  EXPECT_FALSE(queue.TryPop(value));
  int next_out = 0;
  for (int in = 0; in < 100; in += 3) {
    for (int k = 0; k < 3; ++k) {
      ASSERT_TRUE(queue.TryPush(in + k));
    }
    EXPECT_EQ(queue.size(), 3U);
    while (queue.TryPop(value)) {
      EXPECT_EQ(value, next_out++);
    }
  }
  EXPECT_EQ(next_out, 102);
}

TEST(BoundedQueueTest, RefusesWhatDoesNotFitAndLosesNothingByIt) {
  BoundedQueue<int> queue(3);
  EXPECT_EQ(queue.capacity(), 4U);
  for (int i = 0; i < 4; ++i) {
    EXPECT_TRUE(queue.TryPush(i));
  }
  EXPECT_FALSE(queue.TryPush(4));
  int value = 0;
  for (int i = 0; i < 4; ++i) {
    ASSERT_TRUE(queue.TryPop(value));
    EXPECT_EQ(value, i);
  }
}

TEST(BoundedQueueTest, OrdinaryTrafficLeavesThePlacesThatAreKeptFree) {
  BoundedQueue<int> queue(8);
  int pushed = 0;
  while (queue.TryPush(0, 2)) {
    ++pushed;
  }
  EXPECT_EQ(pushed, 6);
  EXPECT_TRUE(queue.TryPush(1));
  EXPECT_TRUE(queue.TryPush(1));
  EXPECT_FALSE(queue.TryPush(1));
}

TEST(BoundedQueueTest, CarriesValuesThatCanOnlyBeMoved) {
  BoundedQueue<std::unique_ptr<int>> queue(2);
  EXPECT_TRUE(queue.TryPush(std::make_unique<int>(7)));
  std::unique_ptr<int> value;
  ASSERT_TRUE(queue.TryPop(value));
  EXPECT_EQ(*value, 7);
}

struct Tagged {
  int producer = 0;
  int number = 0;
};

TEST(BoundedQueueTest, KeepsTheOrderOfEveryProducerWhenManyPushAtOnce) {
  constexpr int kProducers = 3;
  constexpr int kEach = 10'000;
  BoundedQueue<Tagged> queue(64);
  std::vector<std::thread> producers;
  for (int p = 0; p < kProducers; ++p) {
    producers.emplace_back([&queue, p] {
      for (int i = 0; i < kEach; ++i) {
        while (!queue.TryPush({p, i})) {
          std::this_thread::yield();
        }
      }
    });
  }
  std::array<int, kProducers> next{};
  Tagged value;
  for (int taken = 0; taken < kProducers * kEach;) {
    if (!queue.TryPop(value)) {
      std::this_thread::yield();
      continue;
    }
    ++taken;
    ASSERT_EQ(value.number, next[static_cast<std::size_t>(value.producer)]++);
  }
  for (std::thread& producer : producers) {
    producer.join();
  }
  EXPECT_EQ(queue.size(), 0U);
}

}  // namespace
}  // namespace limbcast::runtime
