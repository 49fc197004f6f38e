#include "services/gateway/drivers/simulator/simulator_driver.hpp"

#include <gtest/gtest.h>

#include <cstring>
#include <string>

namespace limbcast::gateway {
namespace {

// All that a run gives, as comparable bytes.
std::string RunTicks(Driver& driver, int ticks) {
  std::string bytes;
  const auto add = [&bytes](const auto& value) {
    bytes.append(reinterpret_cast<const char*>(&value), sizeof value);
  };
  Batch batch;
  for (int i = 0; i < ticks; ++i) {
    const auto step = driver.Next(batch);
    EXPECT_TRUE(step.ok() && *step == DriverStep::kData);
    for (const auto& sample : batch.marg) {
      add(sample.sensor_uid.value);
      for (int axis = 0; axis < 3; ++axis) {
        add(sample.gyro_rad_s[axis]);
        add(sample.accel_m_s2[axis]);
        add(sample.mag_tesla[axis]);
      }
    }
  }
  return bytes;
}

TEST(SimulatorDriverTest, DescribesPeopleAndSensors) {
  SimulatorConfig config;
  config.persons = 2;
  config.sensors = simulation::SensorSet::kReduced15;
  const auto driver = SimulatorDriver::Make(config);
  ASSERT_TRUE(driver.ok());
  const DriverDescription& description = (*driver)->Describe();
  EXPECT_EQ(description.driver, "simulator");
  EXPECT_EQ(description.time, DriverTime::kRecording);
  EXPECT_EQ(description.tick_rate_hz, 100.0);
  EXPECT_TRUE(description.has_truth);
  ASSERT_EQ(description.bodies.size(), 2U);
  EXPECT_EQ(description.bodies[1].sensors.size(), 15U);
  EXPECT_EQ(description.bodies[1].revision, 1U);
  ASSERT_EQ(description.sensors.size(), 30U);
  EXPECT_EQ(description.sensors[15].sensor_uid, description.bodies[1].sensors[0].sensor_uid);
  EXPECT_EQ(description.sensors[0].serial, "sim-1-pelvis");
  EXPECT_GT(description.sensors[0].gyro_range_rad_s, 30.0F);
}

TEST(SimulatorDriverTest, SameSeedSameBits) {
  SimulatorConfig config;
  config.faults.rate.fill(0.01);
  const std::string first = RunTicks(**SimulatorDriver::Make(config), 800);
  const std::string second = RunTicks(**SimulatorDriver::Make(config), 800);
  EXPECT_TRUE(first == second);
  ++config.seed;
  EXPECT_FALSE(first == RunTicks(**SimulatorDriver::Make(config), 800));
}

TEST(SimulatorDriverTest, TicksAtItsRateAndEnds) {
  SimulatorConfig config;
  config.rate_hz = 60.0;
  config.duration_s = 0.5;
  auto driver = *SimulatorDriver::Make(config);
  Batch batch;
  Time last{};
  for (int i = 0; i < 30; ++i) {
    ASSERT_EQ(*driver->Next(batch), DriverStep::kData);
    if (i > 0) {
      EXPECT_NEAR(ToSeconds(batch.tick_at - last), 1.0 / 60.0, 2e-9);
    }
    last = batch.tick_at;
    EXPECT_EQ(batch.marg.front().measured_at, batch.tick_at);
  }
  EXPECT_EQ(*driver->Next(batch), DriverStep::kEnd);
  EXPECT_TRUE(batch.marg.empty());
}

TEST(SimulatorDriverTest, RewindsToTheSameBits) {
  SimulatorConfig config;
  config.duration_s = 1.0;
  auto driver = *SimulatorDriver::Make(config);
  const std::string first = RunTicks(*driver, 100);
  ASSERT_TRUE(driver->Rewind().ok());
  EXPECT_TRUE(first == RunTicks(*driver, 100));

  config.duration_s = 0.0;
  EXPECT_EQ((*SimulatorDriver::Make(config))->Rewind().error().code, ErrorCode::kUnsupported);
}

TEST(SimulatorDriverTest, GapsAreCountedAsLostByTheDevice) {
  SimulatorConfig config;
  config.faults.gap_ticks = 4;
  config.faults.list = {
      {.tick = 2, .body = 1, .segment = body::Segment::kHead, .fault = Fault::kGap}};
  auto driver = *SimulatorDriver::Make(config);
  Batch batch;
  std::uint64_t lost = 0;
  std::size_t samples = 0;
  for (int i = 0; i < 10; ++i) {
    ASSERT_EQ(*driver->Next(batch), DriverStep::kData);
    lost += batch.device_lost;
    samples += batch.marg.size();
  }
  EXPECT_EQ(lost, 4U);
  EXPECT_EQ(samples, 166U);
}

TEST(SimulatorDriverTest, RefusesWhatIsOutOfRange) {
  SimulatorConfig config;
  config.persons = 0;
  const auto driver = SimulatorDriver::Make(config);
  ASSERT_FALSE(driver.ok());
  EXPECT_NE(driver.error().message.find("simulator.persons"), std::string::npos);
}

}  // namespace
}  // namespace limbcast::gateway
