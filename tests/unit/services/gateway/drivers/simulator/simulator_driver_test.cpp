#include "services/gateway/drivers/simulator/simulator_driver.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cstring>
#include <set>
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

SimulatorConfig WithCoils() {
  SimulatorConfig config;
  config.persons = 2;
  config.iron = false;
  config.coils.source = body::Segment::kPelvis;
  return config;
}

// When each source was on, in host time modulo a frame of 400 ms, in ticks of 10 ms.
std::array<std::set<int>, 2> TicksOn(SimulatorDriver& driver, int from, int to) {
  std::array<std::set<int>, 2> on;
  Batch batch;
  for (int tick = from; tick < to; ++tick) {
    EXPECT_TRUE(driver.Next(batch));
    for (std::size_t i = 0; i < 2; ++i) {
      if (batch.coil_drives[i].drive.coil >= 0) {
        on[i].insert((tick + 7) % 40);
      }
    }
  }
  return on;
}

TEST(SimulatorDriverTest, CoilsPulseInTheSlotsThatTheyAreGranted) {
  const auto driver = *SimulatorDriver::Make(WithCoils());
  EXPECT_EQ(driver->Describe().bodies[1].coil_slot, 2U);
  EXPECT_EQ(driver->Describe().bodies[1].coil_slots, 2U);
  EXPECT_EQ(driver->Describe().bodies[1].coil_frame_us, 200'000U);
  using namespace std::chrono_literals;
  const sensing::CoilGrant second{.slot = 1, .slots = 4, .frame = 400ms};
  const sensing::CoilGrant last{.slot = 3, .slots = 4, .frame = 400ms};
  CoilSchedule schedule{
      .own = {{{1}, last}, {{2}, second}}, .foreign = {}, .to_host = 40'000'075ms};
  ASSERT_TRUE(driver->FollowSlots(schedule).ok());
  auto on = TicksOn(*driver, 0, 400);
  EXPECT_EQ(on[0], (std::set<int>{30, 31, 32, 33, 34, 35}));
  EXPECT_EQ(on[1], (std::set<int>{10, 11, 12, 13, 14, 15}));
  // One is taken away; the other goes on as it was.
  schedule.own[1].grant.reset();
  ASSERT_TRUE(driver->FollowSlots(schedule).ok());
  on = TicksOn(*driver, 400, 800);
  EXPECT_EQ(on[0], (std::set<int>{30, 31, 32, 33, 34, 35}));
  EXPECT_TRUE(on[1].empty());
  // Slots of 50 ms do not hold pulses of 60.
  schedule.own[0].grant->slots = 8;
  const Status fits = driver->FollowSlots(schedule);
  ASSERT_FALSE(fits.ok());
  EXPECT_NE(fits.error().message.find("0.05"), std::string::npos) << fits.error().message;
  on = TicksOn(*driver, 800, 900);
  EXPECT_TRUE(on[0].empty());
}

TEST(SimulatorDriverTest, FromTheBeginningAgainTheSlotsAreTheSame) {
  SimulatorConfig config = WithCoils();
  config.duration_s = 2.0;
  const auto driver = *SimulatorDriver::Make(config);
  CoilSchedule schedule;
  schedule.own = {{{1}, std::nullopt}, {{2}, sensing::CoilGrant{}}};
  ASSERT_TRUE(driver->FollowSlots(schedule).ok());
  EXPECT_TRUE(TicksOn(*driver, 0, 200)[0].empty());
  ASSERT_TRUE(driver->Rewind().ok());
  const auto on = TicksOn(*driver, 0, 200);
  EXPECT_TRUE(on[0].empty());
  EXPECT_FALSE(on[1].empty());
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
