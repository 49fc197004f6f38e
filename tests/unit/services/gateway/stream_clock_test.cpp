#include "services/gateway/stream_clock.hpp"

#include <gtest/gtest.h>

namespace limbcast::gateway {
namespace {

using namespace std::chrono_literals;

constexpr Time kNow = TimeFromNanoseconds(1'700'000'000'000'000'000);
constexpr Time At(Duration offset) { return Time{offset}; }

TEST(StreamClockTest, InRealTimeStreamTimeIsDueTime) {
  StreamClock clock({});
  clock.Start(At(5s), kNow);
  EXPECT_EQ(clock.DueAt(At(5s), kNow), kNow);
  EXPECT_FALSE(clock.Send(At(5s), kNow));
  EXPECT_EQ(clock.ToStream(At(5s)), kNow);
  EXPECT_EQ(clock.DueAt(At(5010ms), kNow), kNow + 10ms);
  EXPECT_EQ(clock.ToStream(At(5010ms)), kNow + 10ms);
}

TEST(StreamClockTest, FasterPlayKeepsTheSpacingOfSamples) {
  StreamClock clock({.speed = 10.0});
  clock.Start(At(0s), kNow);
  clock.Send(At(0s), kNow);
  EXPECT_EQ(clock.DueAt(At(1s), kNow), kNow + 100ms);
  EXPECT_EQ(clock.ToStream(At(1s)), kNow + 1s);  // runs ahead of the clock
}

TEST(StreamClockTest, AsFastAsPossibleIsAlwaysDue) {
  StreamClock clock({.as_fast = true});
  clock.Start(At(0s), kNow);
  clock.Send(At(0s), kNow);
  EXPECT_EQ(clock.DueAt(At(100s), kNow + 3ms), kNow + 3ms);
  EXPECT_FALSE(clock.Send(At(100s), kNow + 3ms));
  EXPECT_EQ(clock.ToStream(At(100s)), kNow + 100s);
  EXPECT_EQ(clock.DueInRealTime(At(100010ms)), kNow + 13ms);
}

TEST(StreamClockTest, LateSenderDoesNotDrift) {
  StreamClock clock({});
  clock.Start(At(0s), kNow);
  clock.Send(At(0s), kNow);
  clock.Send(At(10ms), kNow + 13ms);
  EXPECT_EQ(clock.lag(), 3ms);
  EXPECT_EQ(clock.DueAt(At(20ms), kNow + 13ms), kNow + 20ms);
  EXPECT_EQ(clock.ToStream(At(20ms)), kNow + 20ms);
}

TEST(StreamClockTest, CatchesUpAtFourTimesTheSpeedInsteadOfInOneBurst) {
  StreamClock clock({});
  clock.Start(At(0s), kNow);
  clock.Send(At(0s), kNow);
  Time now = kNow + 300ms;  // was held up
  int ticks = 0;
  for (Time tick = At(10ms);; tick += 10ms, ++ticks) {
    const Time due = clock.DueAt(tick, now);
    if (due > now && due - now > 2500us) {
      break;  // back in step
    }
    now = std::max(now, due);
    EXPECT_FALSE(clock.Send(tick, now));
  }
  EXPECT_NEAR(ticks, 40, 2);  // 30 ticks behind, made up at 3 gained in each 4 sent
  EXPECT_EQ(clock.ToStream(At(0s)), kNow);
}

TEST(StreamClockTest, TooLateJumpsToNow) {
  StreamClock clock({});
  clock.Start(At(0s), kNow);
  clock.Send(At(0s), kNow);
  EXPECT_TRUE(clock.Send(At(10ms), kNow + 5s));
  EXPECT_EQ(clock.ToStream(At(10ms)), kNow + 5s);
  EXPECT_EQ(clock.DueAt(At(20ms), kNow + 5s), kNow + 5s + 10ms);
}

TEST(StreamClockTest, ClockSetBackDoesNotStallTheStream) {
  StreamClock clock({});
  clock.Start(At(0s), kNow);
  clock.Send(At(0s), kNow);
  const Time set_back = kNow - 3600s;
  EXPECT_EQ(clock.DueAt(At(10ms), set_back), set_back);
  EXPECT_TRUE(clock.Send(At(10ms), set_back));
  EXPECT_EQ(clock.ToStream(At(10ms)), set_back);
}

TEST(StreamClockTest, LoopGoesOnOnePeriodAfterTheLastTick) {
  for (const double speed : {1.0, 2.0}) {
    StreamClock clock({.speed = speed});
    clock.Start(At(1s), kNow);
    clock.Send(At(1s), kNow);
    const Time sent = clock.DueAt(At(2s), kNow);
    clock.Send(At(2s), sent);
    clock.Loop(At(1s), 10ms);
    EXPECT_EQ(clock.ToStream(At(1s)), kNow + 1010ms);
    EXPECT_EQ(clock.DueAt(At(1s), sent), sent + Duration(10ms) / static_cast<int>(speed));
    clock.Send(At(1s), clock.DueAt(At(1s), sent));
    EXPECT_EQ(clock.ToStream(At(1500ms)), kNow + 1510ms);
  }
}

}  // namespace
}  // namespace limbcast::gateway
