#include "services/gateway/drivers/replay/arrival_order.hpp"

#include <gtest/gtest.h>

namespace limbcast::gateway {
namespace {

Time At(int ms) { return Time{std::chrono::milliseconds(ms)}; }

TEST(ArrivalOrderTest, TicksGrowStrictlyAndKeepEverySample) {
  Collected collected;
  // Sensor 0 at 0, 20, 10 (late) ms; sensor 1 at 20 ms with one lost before it.
  for (const int ms : {0, 20, 10, 20}) {
    sensing::MargSample sample;
    sample.measured_at = At(ms);
    collected.marg.push_back(sample);
  }
  collected.arrived = {
      {.sensor = 0, .index = 0, .arrived_at = At(0)},
      {.sensor = 0, .index = 1, .arrived_at = At(20)},
      {.sensor = 0, .index = 2, .arrived_at = At(20)},
      {.sensor = 1, .index = 3, .arrived_at = At(20), .lost_before = 1},
  };
  Recording recording;
  BuildTicks(collected, recording);

  ASSERT_EQ(recording.ticks.size(), 2U);
  EXPECT_EQ(recording.ticks[0].marg_end, 1U);
  EXPECT_EQ(recording.ticks[1].marg_end, 4U);
  EXPECT_EQ(recording.ticks[1].device_lost, 1U);
  EXPECT_EQ(recording.marg[2].measured_at, At(10));
  EXPECT_EQ(recording.out_of_order, 1U);
}

}  // namespace
}  // namespace limbcast::gateway
