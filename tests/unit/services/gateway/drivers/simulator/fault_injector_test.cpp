#include "services/gateway/drivers/simulator/fault_injector.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <string>

namespace limbcast::gateway {
namespace {

using body::Segment;
using sensing::MargSample;

sensing::SensorInfo Info() {
  sensing::SensorInfo info;
  info.gyro_range_rad_s = 35.0F;
  info.accel_range_m_s2 = 160.0F;
  return info;
}

MargSample SampleAt(std::uint64_t tick) {
  MargSample sample;
  sample.measured_at = TimeFromNanoseconds(static_cast<std::int64_t>(tick));
  sample.gyro_rad_s.setConstant(0.1F);
  return sample;
}

// What comes out of ten ticks.
std::vector<MargSample> RunTicks(FaultInjector& injector, std::uint64_t ticks = 10) {
  std::vector<MargSample> out;
  for (std::uint64_t tick = 0; tick < ticks; ++tick) {
    injector.Pass(tick, SampleAt(tick), out);
  }
  return out;
}

std::vector<MargSample> RunWith(Fault fault) {
  FaultConfig config;
  config.gap_ticks = 3;
  config.list = {{.tick = 4, .body = 1, .segment = Segment::kHead, .fault = fault}};
  FaultInjector injector(config, 1, Segment::kHead, Info(), simulation::Random(1));
  return RunTicks(injector);
}

TEST(FaultInjectorTest, PassesEverythingThroughWithoutFaults) {
  FaultInjector injector({}, 1, Segment::kHead, Info(), simulation::Random(1));
  EXPECT_EQ(RunTicks(injector).size(), 10U);
}

TEST(FaultInjectorTest, ListedFaultsHappenWhereTheyAreListed) {
  const auto not_finite = RunWith(Fault::kNotFinite);
  ASSERT_EQ(not_finite.size(), 10U);
  EXPECT_TRUE(std::isnan(not_finite[4].gyro_rad_s.y()));
  EXPECT_TRUE(not_finite[5].gyro_rad_s.allFinite());

  const auto saturated = RunWith(Fault::kSaturated);
  EXPECT_EQ(saturated[4].gyro_rad_s.x(), 35.0F);
  EXPECT_TRUE(saturated[4].Has(sensing::kGyroSaturated));
  EXPECT_TRUE(saturated[4].Has(sensing::kAccelSaturated));

  const auto duplicate = RunWith(Fault::kDuplicate);
  ASSERT_EQ(duplicate.size(), 11U);
  EXPECT_EQ(duplicate[4].measured_at, duplicate[5].measured_at);

  const auto swapped = RunWith(Fault::kOutOfOrder);
  ASSERT_EQ(swapped.size(), 10U);
  EXPECT_EQ(swapped[4].measured_at, SampleAt(5).measured_at);
  EXPECT_EQ(swapped[5].measured_at, SampleAt(4).measured_at);

  const auto gap = RunWith(Fault::kGap);
  ASSERT_EQ(gap.size(), 7U);
  EXPECT_EQ(gap[4].measured_at, SampleAt(7).measured_at);

  const auto no_mag = RunWith(Fault::kMagMissing);
  EXPECT_TRUE(no_mag[4].Has(sensing::kMagMissing));
  EXPECT_FALSE(no_mag[5].Has(sensing::kMagMissing));
}

TEST(FaultInjectorTest, TheListOfOthersIsNotMine) {
  FaultConfig config;
  config.list = {{.tick = 4, .body = 2, .segment = Segment::kHead, .fault = Fault::kGap},
                 {.tick = 5, .body = 1, .segment = Segment::kPelvis, .fault = Fault::kGap}};
  FaultInjector injector(config, 1, Segment::kHead, Info(), simulation::Random(1));
  EXPECT_EQ(RunTicks(injector).size(), 10U);
}

TEST(FaultInjectorTest, RatesAreKept) {
  FaultConfig config;
  config.rate = {0.02, 0.03, 0.04, 0.05, 0.0, 0.06};
  FaultInjector injector(config, 1, Segment::kHead, Info(), simulation::Random(5));
  constexpr std::uint64_t kTicks = 50'000;
  const auto out = RunTicks(injector, kTicks);
  for (std::size_t i = 0; i < kFaultCount; ++i) {
    EXPECT_NEAR(static_cast<double>(injector.counts()[i]) / kTicks, config.rate[i], 0.004) << i;
  }
  EXPECT_NEAR(static_cast<double>(out.size()), static_cast<double>(kTicks + injector.counts()[2]),
              1.0);  // duplicates
}

TEST(FaultInjectorTest, ValidateNamesTheRate) {
  FaultConfig config;
  config.rate[static_cast<std::size_t>(Fault::kGap)] = 1.5;
  EXPECT_NE(Validate(config).error().message.find("gap_rate"), std::string::npos);
  config.rate.fill(0.3);
  EXPECT_NE(Validate(config).error().message.find("together"), std::string::npos);
  config.rate.fill(0.0);
  config.gap_ticks = 0;
  EXPECT_NE(Validate(config).error().message.find("gap_ticks"), std::string::npos);
}

}  // namespace
}  // namespace limbcast::gateway
