#include "services/fusion/coil_track.hpp"

#include <gtest/gtest.h>

#include "tests/support/position_run.hpp"

namespace limbcast::fusion {
namespace {

using body::Segment;
using test_support::CoilAid;
using test_support::CoilPeople;
using test_support::RunPositions;

// Stands, walks, gestures: wrists and shins against a source on the pelvis.
TEST(CoilTrackTest, WristsAndShinsOfAWalkerArePlaced) {
  const auto figures = RunPositions(CoilPeople(), CoilAid(), 25.0, 6.0);
  for (const auto& [key, figure] : figures) {
    SCOPED_TRACE(testing::Message() << body::ToString(key.second) << " rms " << figure.rms_m
                                    << " max " << figure.max_m << " sigma " << figure.sigma_m);
    const bool wrist = body::IsArm(key.second);
    EXPECT_GT(figure.first_s, 2.0) << "before it moves nobody knows on which side it is";
    EXPECT_LT(figure.first_s, 5.0);
    EXPECT_GT(figure.count, 0.95 * figure.expected);
    EXPECT_LT(figure.rms_m, wrist ? 0.03 : 0.02);
  }
  EXPECT_EQ(figures.size(), 4U);
}

TEST(CoilTrackTest, WhatComesAfterMakesAPositionBetterHalfASecondLater) {
  PositionConfig config = CoilAid();
  config.lag_s = 0.5;
  const auto figures = RunPositions(CoilPeople(), config, 20.0, 6.0, 0.3);
  for (const auto& [key, figure] : figures) {
    SCOPED_TRACE(testing::Message() << body::ToString(key.second) << " rms " << figure.rms_m
                                    << " lagged " << figure.lagged_rms_m);
    EXPECT_GT(figure.lagged_count, 0.9 * figure.expected);
    EXPECT_LT(figure.lagged_rms_m, 0.8 * figure.rms_m);
  }
}

// A walker is never still; what would begin there would be wrong for a long time.
TEST(CoilTrackTest, HeardInTheMiddleOfAWalkItWaitsForRest) {
  const auto figures = RunPositions(CoilPeople(), CoilAid(), 30.0, 8.0, 0.0, 8.0);
  int placed = 0;
  for (const auto& [key, figure] : figures) {
    if (figure.count > 0) {
      ++placed;
      EXPECT_LT(figure.max_m, 0.15) << body::ToString(key.second);
    }
  }
  EXPECT_GE(placed, 2) << "it stands before it gestures";
}

// The answer is in the axes of the orientation that it is given: an error of that takes no part.
TEST(CoilTrackTest, ItTurnsWithTheOrientationOfTheSource) {
  const auto straight = RunPositions(CoilPeople(), CoilAid(), 8.0, 6.0);
  const auto turned = RunPositions(CoilPeople(), CoilAid(), 8.0, 6.0, 0.5);
  for (const auto& [key, figure] : straight) {
    EXPECT_NEAR(turned.at(key).rms_m, figure.rms_m, 1e-5) << body::ToString(key.second);
  }
}

TEST(CoilTrackTest, SamplesOfTheSourceThatAreFarInTimeAreNotUsed) {
  CoilTrack track(CoilAid().coils);
  sensing::MargSample sample;
  sample.accel_m_s2.z() = 9.81F;
  sample.mag_tesla = {0.0F, 2e-5F, -4e-5F};
  sensing::MargSample source = sample;
  source.measured_at = TimeFromNanoseconds(1);
  for (int i = 1; i < 200; ++i) {
    sample.measured_at = TimeFromNanoseconds(1'000'000'000LL + i * 10'000'000LL);
    EXPECT_FALSE(track.Update(sample, source, Eigen::Quaterniond::Identity()));
  }
  EXPECT_EQ(track.filter().filter().phase(), filters::CoilPhase::kLevelling);
}

}  // namespace
}  // namespace limbcast::fusion
