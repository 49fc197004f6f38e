#include "common/filters/position/marker_gate.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace limbcast::filters {
namespace {

using Eigen::Vector3d;

Time Ms(double ms) { return Time{} + DurationFromSeconds(1e-3 * ms); }

sensing::MarkerPosition Seen(double ms, double x) {
  sensing::MarkerPosition marker;
  marker.measured_at = Ms(ms);
  marker.visible = true;
  marker.p_earth_marker_m = {x, 0.0, 1.0};
  return marker;
}

TEST(MarkerGateTest, HiddenAndNotFiniteAreNoUpdate) {
  MarkerGate gate;
  sensing::MarkerPosition hidden = Seen(0, 0.1);
  hidden.visible = false;
  EXPECT_EQ(gate.Push(hidden), MarkerVerdict::kHidden);
  EXPECT_EQ(gate.Push(Seen(1, std::numeric_limits<double>::quiet_NaN())), MarkerVerdict::kHidden);
  MarkerCounters counters;
  EXPECT_FALSE(gate.Take(Ms(100), counters).has_value());
}

TEST(MarkerGateTest, TheThirdIdenticalOneCountsAsMissing) {
  MarkerGate gate;
  EXPECT_EQ(gate.Push(Seen(0, 0.1)), MarkerVerdict::kQueued);
  EXPECT_EQ(gate.Push(Seen(8, 0.1)), MarkerVerdict::kQueued);
  EXPECT_EQ(gate.Push(Seen(16, 0.1)), MarkerVerdict::kRepeated);
  EXPECT_EQ(gate.Push(Seen(24, 0.1)), MarkerVerdict::kRepeated);
  EXPECT_EQ(gate.Push(Seen(32, 0.2)), MarkerVerdict::kQueued);
}

TEST(MarkerGateTest, TimeGoingBackOrStandingStillDropsTheSample) {
  MarkerGate gate;
  EXPECT_EQ(gate.Push(Seen(10, 0.1)), MarkerVerdict::kQueued);
  EXPECT_EQ(gate.Push(Seen(10, 0.2)), MarkerVerdict::kOutOfOrder);
  EXPECT_EQ(gate.Push(Seen(5, 0.2)), MarkerVerdict::kOutOfOrder);
}

TEST(MarkerGateTest, GivesTheNewestOfABlock) {
  MarkerGate gate;
  for (int i = 1; i <= 5; ++i) {
    (void)gate.Push(Seen(i, 0.1 * i));
  }
  MarkerCounters counters;
  const auto taken = gate.Take(Ms(3), counters);
  ASSERT_TRUE(taken.has_value());
  EXPECT_EQ(taken->at, Ms(3));
  EXPECT_EQ(counters[MarkerVerdict::kSuperseded], 2U);
  EXPECT_EQ(gate.Take(Ms(4), counters)->at, Ms(4));
  EXPECT_FALSE(gate.Take(Ms(4), counters).has_value());
}

TEST(MarkerGateTest, WithoutInertialReadingsTheOldestFallOut) {
  MarkerGate gate;
  for (int i = 1; i <= 1000; ++i) {
    EXPECT_EQ(gate.Push(Seen(i, 0.001 * i)), MarkerVerdict::kQueued);
  }
  MarkerCounters counters;
  EXPECT_EQ(gate.Take(Ms(1000), counters)->at, Ms(1000));
}

TEST(OutlierRunTest, WhatMovesOnItsOwnIsForeign) {
  OutlierRun ghost;
  OutlierRun label_jump;
  for (int i = 0; i < 40; ++i) {
    const double t_s = 0.01 * i;
    // A still ghost beside a limb that swings; a marker of the same limb, 0.2 m away.
    ghost.AddRejected(Ms(10 * i), Vector3d(0.3 + 0.1 * std::sin(12.0 * t_s), 0.0, 0.0));
    label_jump.AddRejected(Ms(10 * i), Vector3d(0.2, 0.01 * t_s, 0.0));
    if (i < 20) {
      EXPECT_FALSE(ghost.foreign()) << "too short a run to say";
    }
  }
  EXPECT_TRUE(ghost.foreign());
  EXPECT_FALSE(label_jump.foreign());
}

TEST(OutlierRunTest, AfterASecondTheFilterIsInDoubt) {
  OutlierRun run;
  for (int i = 0; i <= 101; ++i) {
    run.AddRejected(Ms(10 * i), Vector3d(std::sin(0.3 * i), 0.0, 0.0));
  }
  EXPECT_TRUE(run.in_doubt());
  EXPECT_FALSE(run.foreign());
  run.Clear();
  EXPECT_TRUE(run.empty());
}

}  // namespace
}  // namespace limbcast::filters
