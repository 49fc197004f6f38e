#include "common/sensing/coil_slots.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace limbcast::sensing {
namespace {

// Design/position.md section 11: capacity at a guard of 2 ms.
struct Capacity {
  double pulse_s;
  double bursts_per_s;
  double users;
  double slots_per_s;
};
class CoilSlotsCapacityTest : public testing::TestWithParam<Capacity> {};

TEST_P(CoilSlotsCapacityTest, CapacityIsThatOfTheSpecification) {
  CoilSlotConfig config;
  config.pulse_s = GetParam().pulse_s;
  const CoilSlotPlan plan = PlanCoilSlots(config);
  EXPECT_NEAR(plan.guard_s, 0.002, 1e-12);
  EXPECT_NEAR(plan.bursts_per_s, GetParam().bursts_per_s, 0.05);
  EXPECT_NEAR(plan.users, GetParam().users, 0.07);
  EXPECT_NEAR(plan.slots_per_s, GetParam().slots_per_s, 0.5);
}
INSTANTIATE_TEST_SUITE_P(Pulses, CoilSlotsCapacityTest,
                         testing::Values(Capacity{0.060, 4.9, 2.9, 16},
                                         Capacity{0.034, 8.0, 4.8, 28},
                                         Capacity{0.017, 13.5, 8.1, 53}));

TEST(CoilSlotsTest, FreeRunningSamplesCostAPeriod) {
  CoilSlotConfig config;
  config.free_running_hz = 120.0;
  EXPECT_NEAR(PlanCoilSlots(config).guard_s, 0.010, 4e-4);
}

TEST(CoilSlotsTest, ForeignFieldsAreThoseOfTheSpecification) {
  EXPECT_NEAR(1e9 * ForeignField_tesla(0.713, 1.0), 101.0, 0.5);
  EXPECT_NEAR(1e9 * ForeignField_tesla(0.713, 1.5), 30.0, 0.5);
  EXPECT_NEAR(1e9 * ForeignField_tesla(0.713, 2.0), 13.0, 0.5);
  EXPECT_NEAR(1e9 * ForeignField_tesla(0.713, 3.0), 3.7, 0.05);
  EXPECT_NEAR(PlanCoilSlots({}).reuse_distance_m, 2.7, 0.05);
}

TEST(CoilSlotsTest, ASlotComesOnceInEachFrameOfTheSystemClock) {
  using namespace std::chrono_literals;
  const CoilGrant grant{.slot = 2, .slots = 4, .frame = 200ms};
  EXPECT_EQ(grant.slot_length(), 50ms);
  const auto at = [](Duration since) { return TimeFromNanoseconds(0) + 1000h + since; };
  EXPECT_FALSE(IsInSlot(grant, at(100ms - 1ns)));
  EXPECT_TRUE(IsInSlot(grant, at(100ms)));
  EXPECT_TRUE(IsInSlot(grant, at(150ms - 1ns)));
  EXPECT_FALSE(IsInSlot(grant, at(150ms)));
  EXPECT_TRUE(IsInSlot(grant, at(520ms)));
  EXPECT_EQ(NextSlotBegin(grant, at(100ms)), at(100ms));
  EXPECT_EQ(NextSlotBegin(grant, at(100ms + 1ns)), at(300ms));
  EXPECT_EQ(NextSlotBegin(grant, at(10ms)), at(100ms));
  // Before 1970 as well, and where the slots do not divide the frame.
  EXPECT_TRUE(IsInSlot(grant, TimeFromNanoseconds(-80'000'000)));
  EXPECT_EQ(NextSlotBegin(grant, TimeFromNanoseconds(-150'000'000)),
            TimeFromNanoseconds(-100'000'000));
  const CoilGrant odd{.slot = 2, .slots = 3, .frame = 100ns};
  EXPECT_TRUE(IsInSlot(odd, TimeFromNanoseconds(66)));
  EXPECT_FALSE(IsInSlot(odd, TimeFromNanoseconds(99))) << "what is left of a frame is nobody's";
}

TEST(CoilSlotsTest, RangesAreChecked) {
  EXPECT_TRUE(Validate(CoilSlotConfig{}));
  CoilSlotConfig config;
  config.pulse_s = 0.0;
  EXPECT_FALSE(Validate(config));
  config = {};
  config.moment_a_m2 = std::nan("");
  EXPECT_FALSE(Validate(config));
}

}  // namespace
}  // namespace limbcast::sensing
