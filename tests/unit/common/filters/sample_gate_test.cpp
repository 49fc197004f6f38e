#include "common/filters/sample_gate.hpp"

#include <gtest/gtest.h>

#include <chrono>
#include <cmath>
#include <limits>

#include "common/filters/filter_constants.hpp"

namespace limbcast::filters {
namespace {

using namespace std::chrono_literals;
using Eigen::Vector3d;
using sensing::MargSample;

MargSample At(Duration since_start) {
  MargSample sample;
  sample.measured_at = TimeFromNanoseconds(1'700'000'000'000'000'000) + since_start;
  sample.gyro_rad_s = {1.0F, 0.0F, 0.0F};
  sample.accel_m_s2 = {0.0F, 0.0F, 9.81F};
  sample.mag_tesla = {0.0F, 20e-6F, -40e-6F};
  return sample;
}

// A gate that knows the rate of 100 Hz; its last sample is at 990 ms.
SampleGate Running() {
  SampleGate gate;
  for (int i = 0; i < 100; ++i) {
    EXPECT_TRUE(gate.Pass(At(i * 10ms)).usable());
  }
  return gate;
}

TEST(SampleGateTest, TheFirstSampleStartsAndTheNextHasAStep) {
  SampleGate gate;
  const GatedSample first = gate.Pass(At(0ms));
  EXPECT_TRUE(first.restart);
  EXPECT_EQ(first.dt_s, 0.0);
  const GatedSample second = gate.Pass(At(10ms));
  EXPECT_FALSE(second.restart);
  EXPECT_DOUBLE_EQ(second.dt_s, 0.01);
}

TEST(SampleGateTest, AStepOfMoreThanTenNominalOnesIsAGapWithTheMeanRate) {
  SampleGate gate = Running();
  MargSample after = At(990ms + 95ms);
  EXPECT_FALSE(SampleGate(gate).Pass(after).gap);
  after = At(990ms + 200ms);
  after.gyro_rad_s = {3.0F, 0.0F, 0.0F};
  const GatedSample gap = gate.Pass(after);
  EXPECT_TRUE(gap.gap);
  EXPECT_FALSE(gap.restart);
  EXPECT_DOUBLE_EQ(gap.gyro_rad_s.x(), 2.0);
}

TEST(SampleGateTest, AGapOfMoreThanHalfASecondRestarts) {
  SampleGate gate = Running();
  EXPECT_FALSE(SampleGate(gate).Pass(At(990ms + 499ms)).restart);
  EXPECT_TRUE(gate.Pass(At(990ms + 501ms)).restart);
}

TEST(SampleGateTest, ALowRateIsNoGapOnceItIsKnown) {
  SampleGate gate = Running();
  int restarts = 0;
  for (int i = 1; i <= 200; ++i) {
    restarts = gate.Pass(At(990ms + i * 1s)).restart ? i : restarts;
  }
  EXPECT_LT(restarts, 150);
  SampleGate slow;
  EXPECT_TRUE(slow.Pass(At(0s)).restart);
  for (int i = 1; i < 20; ++i) {
    EXPECT_FALSE(slow.Pass(At(i * 1s)).restart);
  }
}

TEST(SampleGateTest, HoldsTheGyroForFiftyMillisecondsOnly) {
  SampleGate gate = Running();
  for (int i = 1; i <= 7; ++i) {
    MargSample sample = At(990ms + i * 10ms);
    sample.gyro_rad_s.z() = std::numeric_limits<float>::quiet_NaN();
    const GatedSample gated = gate.Pass(sample);
    EXPECT_TRUE(gated.usable());
    EXPECT_TRUE(gated.gyro_absent());
    EXPECT_EQ(gated.gyro_held, i <= 5) << i;
    EXPECT_EQ(gated.gyro_rad_s.x(), i <= 5 ? 1.0 : 0.0);
  }
}

TEST(SampleGateTest, RefusesTimesThatDoNotAdvance) {
  SampleGate gate = Running();
  EXPECT_EQ(gate.Pass(At(990ms)).verdict, SampleVerdict::kRejectedDuplicate);
  EXPECT_EQ(gate.Pass(At(980ms)).verdict, SampleVerdict::kRejectedOutOfOrder);
  EXPECT_DOUBLE_EQ(gate.Pass(At(1000ms)).dt_s, 0.01);
}

TEST(SampleGateTest, TakesATimeThatTwentyOrderedSamplesAgreeOn) {
  SampleGate gate = Running();
  for (int i = 1; i < 20; ++i) {
    EXPECT_EQ(gate.Pass(At(-1h + i * 10ms)).verdict, SampleVerdict::kRejectedOutOfOrder);
  }
  const GatedSample taken = gate.Pass(At(-1h + 200ms));
  EXPECT_TRUE(taken.usable());
  EXPECT_TRUE(taken.restart);
}

TEST(SampleGateTest, ExtremeTimesDoNotOverflow) {
  SampleGate gate;
  MargSample sample = At(0ms);
  sample.measured_at = TimeFromNanoseconds(std::numeric_limits<std::int64_t>::min());
  EXPECT_TRUE(gate.Pass(sample).usable());
  sample.measured_at = TimeFromNanoseconds(std::numeric_limits<std::int64_t>::max());
  const GatedSample last = gate.Pass(sample);
  EXPECT_TRUE(last.restart);
}

TEST(SampleGateTest, ChannelsFallOutOneByOne) {
  SampleGate gate = Running();
  MargSample sample = At(1s);
  sample.accel_m_s2 = {0.0F, 0.0F, 0.4F};
  EXPECT_FALSE(SampleGate(gate).Pass(sample).accel_valid);
  sample.accel_m_s2 = {0.0F, 0.0F, 0.5F};
  EXPECT_TRUE(SampleGate(gate).Pass(sample).accel_valid);
  sample.mag_tesla.setZero();
  EXPECT_FALSE(SampleGate(gate).Pass(sample).mag_valid);
  for (const auto flag :
       {sensing::kMagMissing, sensing::kMagSaturated, sensing::kCoilPulseActive}) {
    MargSample flagged = At(1s);
    flagged.flags = flag;
    EXPECT_FALSE(SampleGate(gate).Pass(flagged).mag_valid);
  }
  MargSample held = At(1s);
  held.flags = sensing::kMagHeld;
  EXPECT_TRUE(SampleGate(gate).Pass(held).mag_valid);
}

TEST(SampleGateTest, SaysWhyNothingIsUsable) {
  SampleGate gate = Running();
  MargSample sample = At(1s);
  sample.flags = sensing::kAccelSaturated | sensing::kMagSaturated | sensing::kGyroMissing;
  EXPECT_EQ(gate.Pass(sample).verdict, SampleVerdict::kRejectedSaturated);
  sample = At(1s);
  sample.gyro_rad_s.setConstant(NAN);
  sample.accel_m_s2.setConstant(NAN);
  sample.mag_tesla.setConstant(NAN);
  EXPECT_EQ(gate.Pass(sample).verdict, SampleVerdict::kRejectedNotFinite);
  sample.flags = sensing::kProbe;
  EXPECT_EQ(gate.Pass(sample).verdict, SampleVerdict::kNoData);
}

TEST(SampleGateTest, CountsHowLongTheMagnetometerIsAbsent) {
  SampleGate gate;
  EXPECT_TRUE(std::isinf(gate.mag_absent_s()));
  gate = Running();
  EXPECT_EQ(gate.mag_absent_s(), 0.0);
  MargSample sample = At(1s);
  sample.flags = sensing::kMagMissing;
  EXPECT_TRUE(gate.Pass(sample).usable());
  EXPECT_NEAR(gate.mag_absent_s(), 0.01, 1e-9);
}

}  // namespace
}  // namespace limbcast::filters
