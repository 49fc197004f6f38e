#include "services/fusion/coil_track.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <utility>

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

// The source's magnetometer helps where the flags say that nothing is on, and nowhere else.
TEST(CoilTrackTest, TheSourcesCompassIsHeardBetweenPulses) {
  const gateway::SimulatorConfig people = CoilPeople();
  auto simulator = gateway::SimulatorDriver::Make(people);
  ASSERT_TRUE(simulator);
  const auto driver = gateway::WithCoilPulses(std::move(*simulator));
  CoilTrack as_is(CoilAid().coils);
  CoilTrack spoilt_in_pulses(CoilAid().coils);
  CoilTrack without(CoilAid().coils);
  const auto variance = [](CoilTrack& track, const sensing::MargSample& sample,
                           const sensing::MargSample& source) {
    const auto position = track.Update(sample, source, Eigen::Quaterniond::Identity());
    return position ? position->cov_position_m2.trace() : 0.0;
  };
  gateway::Batch batch;
  double sum = 0.0;
  double sum_without = 0.0;
  for (int tick = 0; tick < static_cast<int>(20.0 * people.rate_hz); ++tick) {
    ASSERT_TRUE(driver->Next(batch));
    const auto of = [&](Segment segment) {
      const auto truth =
          std::find_if(batch.truth.begin(), batch.truth.end(),
                       [&](const body::SegmentTruth& one) { return one.segment == segment; });
      return batch.marg[static_cast<std::size_t>(truth - batch.truth.begin())];
    };
    const sensing::MargSample sample = of(Segment::kRightLowerLeg);
    sensing::MargSample source = of(Segment::kPelvis);
    const double usual = variance(as_is, sample, source);
    sum += usual;
    if ((source.flags & sensing::kCoilPulseActive) != 0) {
      source.mag_tesla = {3e-5F, -1e-5F, 2e-5F};
      source.flags &= ~static_cast<std::uint32_t>(sensing::kMagSaturated);
    }
    ASSERT_EQ(variance(spoilt_in_pulses, sample, source), usual);
    source.flags |= sensing::kMagMissing;
    sum_without += variance(without, sample, source);
  }
  ASSERT_GT(sum, 0.0);
  EXPECT_LT(sum, 0.95 * sum_without);
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
