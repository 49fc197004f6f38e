#include "common/filters/position/inertial_gate.hpp"

#include <gtest/gtest.h>

#include <limits>

namespace limbcast::filters {
namespace {

using namespace std::chrono_literals;
constexpr float kNan = std::numeric_limits<float>::quiet_NaN();

sensing::MargSample At(std::int64_t ms, float rate = 0.5F) {
  sensing::MargSample sample;
  sample.measured_at = Time{} + std::chrono::milliseconds(ms);
  sample.gyro_rad_s = {rate, 0.0F, 0.0F};
  sample.accel_m_s2 = {0.0F, 0.0F, 9.81F};
  return sample;
}

class InertialGateTest : public ::testing::Test {
 protected:
  // Ten good samples at 100 Hz; the last one is at 90 ms.
  InertialGateTest() {
    for (int i = 0; i < 10; ++i) {
      EXPECT_TRUE(gate.Pass(At(10 * i)).usable());
    }
  }
  InertialGate gate{100.0, 20.0};
};

TEST_F(InertialGateTest, PassesGoodSamplesWithTheirStep) {
  const GatedInertial out = gate.Pass(At(100));
  EXPECT_EQ(out.verdict, SampleVerdict::kFused);
  EXPECT_NEAR(out.dt_s, 0.01, 1e-12);
  EXPECT_EQ(out.noise_factor, 1.0);
  EXPECT_FALSE(out.first);
  EXPECT_FALSE(out.long_dropout);
}

TEST_F(InertialGateTest, ShortDropoutIsHeldWithTenfoldNoise) {
  const GatedInertial held = gate.Pass(At(100, kNan));
  EXPECT_EQ(held.verdict, SampleVerdict::kPredictedOnly);
  EXPECT_EQ(held.reading.gyro_rad_s.x(), 0.5);
  EXPECT_EQ(held.noise_factor, InertialGate::kHoldNoise);
  sensing::MargSample missing = At(110);
  missing.flags = sensing::kAccelMissing;
  EXPECT_EQ(gate.Pass(missing).verdict, SampleVerdict::kPredictedOnly);
  EXPECT_FALSE(gate.Pass(At(120)).long_dropout);
  // Samples that never came are the same.
  EXPECT_EQ(gate.Pass(At(160)).noise_factor, InertialGate::kHoldNoise);
}

TEST_F(InertialGateTest, LongDropoutIsReported) {
  for (int i = 10; i < 30; ++i) {
    const GatedInertial out = gate.Pass(At(10 * i, kNan));
    EXPECT_EQ(out.verdict,
              i <= 14 ? SampleVerdict::kPredictedOnly : SampleVerdict::kRejectedNotFinite);
  }
  const GatedInertial back = gate.Pass(At(300));
  EXPECT_TRUE(back.long_dropout);
  EXPECT_NEAR(back.dt_s, 0.16, 1e-12);  // since the last held one
  EXPECT_FALSE(gate.Pass(At(310)).long_dropout);
}

TEST_F(InertialGateTest, TimeGoingBackOrStandingStillDropsTheSample) {
  EXPECT_EQ(gate.Pass(At(90)).verdict, SampleVerdict::kRejectedDuplicate);
  EXPECT_EQ(gate.Pass(At(40)).verdict, SampleVerdict::kRejectedOutOfOrder);
  EXPECT_NEAR(gate.Pass(At(100)).dt_s, 0.01, 1e-12);
}

TEST_F(InertialGateTest, SaturationGivesThirtyfoldNoiseOnBothSidesOfIt) {
  EXPECT_EQ(gate.Pass(At(100, 19.8F)).noise_factor, InertialGate::kSaturationNoise);
  EXPECT_EQ(gate.Pass(At(110)).noise_factor, InertialGate::kSaturationNoise);
  EXPECT_EQ(gate.Pass(At(120)).noise_factor, 1.0);
  sensing::MargSample flagged = At(130);
  flagged.flags = sensing::kAccelSaturated;
  EXPECT_EQ(gate.Pass(flagged).noise_factor, InertialGate::kSaturationNoise);
}

TEST_F(InertialGateTest, LearnsALowerRate) {
  std::int64_t ms = 90;
  bool dropout = true;
  for (int i = 0; i < 200; ++i) {
    dropout = gate.Pass(At(ms += 40)).noise_factor > 1.0;
  }
  EXPECT_FALSE(dropout);
}

TEST(InertialGateStartTest, BeginsWithAGoodSample) {
  InertialGate gate(0.0, 0.0);
  EXPECT_EQ(gate.Pass(At(0, kNan)).verdict, SampleVerdict::kRejectedNotFinite);
  EXPECT_EQ(gate.Pass(At(10, 1e9F)).verdict, SampleVerdict::kRejectedNotFinite);
  sensing::MargSample probe = At(20);
  probe.flags = sensing::kProbe;
  EXPECT_EQ(gate.Pass(probe).verdict, SampleVerdict::kNoData);
  EXPECT_TRUE(gate.Pass(At(30)).first);
}

}  // namespace
}  // namespace limbcast::filters
