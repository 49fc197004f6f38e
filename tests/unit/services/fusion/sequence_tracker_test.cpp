#include "services/fusion/sequence_tracker.hpp"

#include <gtest/gtest.h>

namespace limbcast::fusion {
namespace {

Time At(int tick) { return TimeFromNanoseconds(1'000'000'000LL + 10'000'000LL * tick); }

// Arrives and is used.
SequenceTracker::Arrival Use(SequenceTracker& tracker, std::uint32_t sequence, int tick) {
  const auto arrival = tracker.Arrive(sequence, At(tick));
  if (!arrival.duplicate) {
    tracker.Used(sequence, At(tick));
  }
  return arrival;
}

TEST(SequenceTrackerTest, NumbersInARowAreNeitherLostNorDuplicate) {
  SequenceTracker tracker;
  for (std::uint32_t i = 1; i <= 200; ++i) {
    const auto arrival = Use(tracker, i, static_cast<int>(i));
    EXPECT_FALSE(arrival.duplicate);
    EXPECT_EQ(arrival.lost, 0);
  }
}

TEST(SequenceTrackerTest, WhatCameBeforeTheFirstOneIsNotLost) {
  SequenceTracker tracker;
  EXPECT_EQ(Use(tracker, 5000, 1).lost, 0);
}

TEST(SequenceTrackerTest, AGapIsAsManyLostAsNumbersAreMissing) {
  SequenceTracker tracker;
  Use(tracker, 1, 1);
  EXPECT_EQ(Use(tracker, 5, 5).lost, 3);
  EXPECT_EQ(Use(tracker, 505, 505).lost, 499);
}

TEST(SequenceTrackerTest, TheSameNumberAgainIsADuplicateWithinTheWindow) {
  SequenceTracker tracker;
  for (int i = 1; i <= 70; ++i) {
    Use(tracker, static_cast<std::uint32_t>(i), i);
  }
  EXPECT_TRUE(tracker.Arrive(70, At(70)).duplicate);
  EXPECT_TRUE(tracker.Arrive(69, At(69)).duplicate);
  EXPECT_TRUE(tracker.Arrive(7, At(7)).duplicate) << "63 back";
  EXPECT_FALSE(tracker.Arrive(6, At(6)).duplicate) << "64 back: no longer remembered";
}

TEST(SequenceTrackerTest, ALateOneTakesItsLossBack) {
  SequenceTracker tracker;
  Use(tracker, 1, 1);
  EXPECT_EQ(Use(tracker, 3, 3).lost, 1);
  EXPECT_EQ(tracker.Arrive(2, At(2)).lost, -1);
  EXPECT_TRUE(tracker.Arrive(2, At(2)).duplicate);
}

TEST(SequenceTrackerTest, ALowerNumberWithANewerTimeIsANewCount) {
  SequenceTracker tracker;
  Use(tracker, 1000, 1000);
  const auto restarted = Use(tracker, 1, 1200);
  EXPECT_FALSE(restarted.duplicate);
  EXPECT_EQ(restarted.lost, 0);
  EXPECT_EQ(Use(tracker, 2, 1201).lost, 0);
  EXPECT_TRUE(tracker.Arrive(2, At(1201)).duplicate);

  SequenceTracker missed;
  Use(missed, 1000, 1000);
  EXPECT_EQ(Use(missed, 4, 1200).lost, 3) << "1 to 3 of the new count never came";
}

TEST(SequenceTrackerTest, ACountWithATimeSetBackIsAdoptedOnceTheFilterUsesIt) {
  SequenceTracker tracker;
  Use(tracker, 1000, 1000);
  EXPECT_EQ(tracker.Arrive(1, At(10)).lost, 0);  // refused by the filter: old
  EXPECT_EQ(tracker.Arrive(2, At(11)).lost, 0);
  tracker.Used(2, At(11));
  EXPECT_EQ(tracker.Arrive(3, At(12)).lost, 0);
  EXPECT_TRUE(tracker.Arrive(3, At(12)).duplicate);
}

TEST(SequenceTrackerTest, NumberZeroIsNotJudged) {
  SequenceTracker tracker;
  for (int i = 0; i < 3; ++i) {
    const auto arrival = Use(tracker, 0, i);
    EXPECT_FALSE(arrival.duplicate);
    EXPECT_EQ(arrival.lost, 0);
  }
}

}  // namespace
}  // namespace limbcast::fusion
