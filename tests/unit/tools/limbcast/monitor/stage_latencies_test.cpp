#include "tools/limbcast/monitor/stage_latencies.hpp"

#include <gtest/gtest.h>

#include <chrono>

namespace limbcast::tool {
namespace {

using namespace std::chrono_literals;
constexpr double kBucket = 1.0 / 32.0;

body::Skeleton Skeleton(Time measured_at) {
  body::Skeleton skeleton;
  skeleton.measured_at = measured_at;
  skeleton.stages.gateway_published_at = measured_at + 100us;
  skeleton.stages.fusion_received_at = measured_at + 300us;
  skeleton.stages.fusion_published_at = measured_at + 330us;
  skeleton.stages.posture_received_at = measured_at + 500us;
  skeleton.stages.posture_published_at = measured_at + 560us;
  return skeleton;
}

TEST(StageLatenciesTest, EachStageIsTheTimeBetweenItsDoors) {
  StageLatencies latencies;
  const Time measured_at = TimeFromNanoseconds(1'000'000'000'000);
  latencies.Add(Skeleton(measured_at), measured_at + 800us);

  EXPECT_NEAR(latencies.total().Quantile_us(0.5), 800.0, 800.0 * kBucket);
  const std::array<double, 6> expected_us = {100, 200, 30, 170, 60, 240};
  for (std::size_t i = 0; i < expected_us.size(); ++i) {
    EXPECT_NEAR(latencies.stage(i).Quantile_us(0.5), expected_us[i], expected_us[i] * kBucket)
        << StageLatencies::kNames[i];
  }
}

TEST(StageLatenciesTest, StartsAgainFromNothing) {
  StageLatencies latencies;
  const Time measured_at = TimeFromNanoseconds(1'000'000'000'000);
  latencies.Add(Skeleton(measured_at), measured_at + 800us);
  latencies.Restart();
  EXPECT_EQ(latencies.total().count(), 0U);
  for (std::size_t i = 0; i < StageLatencies::kNames.size(); ++i) {
    EXPECT_EQ(latencies.stage(i).count(), 0U) << StageLatencies::kNames[i];
  }
}

TEST(StageLatenciesTest, ADoorThatWasNotPassedCountsNowhere) {
  StageLatencies latencies;
  const Time measured_at = TimeFromNanoseconds(1'000'000'000'000);
  body::Skeleton skeleton = Skeleton(measured_at);
  skeleton.stages.fusion_received_at = Time{};
  latencies.Add(skeleton, measured_at + 800us);
  EXPECT_EQ(latencies.stage(1).count(), 0U);
  EXPECT_EQ(latencies.stage(2).count(), 0U);
  EXPECT_EQ(latencies.stage(3).count(), 1U);
}

TEST(StageLatenciesTest, ARecordingAheadOfTheClockIsMeasuredFromTheGateway) {
  StageLatencies latencies;
  const Time start = TimeFromNanoseconds(1'000'000'000'000);
  body::Skeleton skeleton = Skeleton(start);
  skeleton.measured_at = start + 10s;
  latencies.Add(skeleton, start + 800us);
  EXPECT_NEAR(latencies.total().Quantile_us(0.5), 700.0, 700.0 * kBucket);
  EXPECT_EQ(latencies.stage(0).count(), 0U);
}

}  // namespace
}  // namespace limbcast::tool
