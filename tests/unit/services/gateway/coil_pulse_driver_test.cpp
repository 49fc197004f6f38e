#include "services/gateway/coil_pulse_driver.hpp"

#include <gtest/gtest.h>

#include <limits>
#include <map>
#include <utility>

#include "common/sensing/coil_field.hpp"
#include "common/sensing/coil_flags.hpp"
#include "services/gateway/drivers/simulator/simulator_driver.hpp"
#include "tests/unit/services/gateway/fake_driver.hpp"

namespace limbcast::gateway {
namespace {

SimulatorConfig Walking(std::uint32_t persons = 1) {
  SimulatorConfig config;
  config.persons = persons;
  config.spacing_m = 1.5;
  config.n_pose_s = 1.0;
  config.iron = false;
  config.coils.source = body::Segment::kPelvis;
  return config;
}

std::unique_ptr<Driver> Make(const SimulatorConfig& config) {
  auto driver = SimulatorDriver::Make(config);
  return WithCoilPulses(std::move(*driver));
}

// One sensor of uid 1 with a source of its own on it, in N ticks; `drive` says what it does.
std::unique_ptr<Driver> Fake(std::function<void(Batch&)> extra) {
  auto fake = std::make_unique<test::FakeDriver>(2, 1000);
  fake->description().coil_sources = {
      {.source_uid = {1}, .body_id = {1}, .sensors = {{2}}, .current_a = 1.5}};
  fake->extra = std::move(extra);
  return WithCoilPulses(std::move(fake));
}

TEST(CoilPulseDriverTest, WithoutSourcesItIsTheDriverItself) {
  auto fake = std::make_unique<test::FakeDriver>(1, 1);
  const Driver* const raw = fake.get();
  EXPECT_EQ(WithCoilPulses(std::move(fake)).get(), raw);
}

TEST(CoilPulseDriverTest, SamplesSayWhichCoilWasOnAndWhichMeanNothing) {
  const auto driver = Fake([](Batch& batch) {
    const auto tick = batch.tick_at.time_since_epoch() / std::chrono::milliseconds(10);
    sensing::CoilDrive drive;
    if (tick == 1 || tick == 2) {
      drive = {.coil = 1, .current_a = tick == 1 ? 1.5 : -1.5};
    }
    drive.settled = tick != 3;
    batch.coil_drives.push_back({.source_uid = {1}, .drive = drive});
  });
  Batch batch;
  constexpr std::uint32_t kOn = sensing::kCoilPulseActive | sensing::kCoilYOn;
  for (const std::uint32_t expected : {0U, kOn, kOn | sensing::kCoilReversed,
                                       static_cast<std::uint32_t>(sensing::kCoilPulseActive), 0U}) {
    ASSERT_TRUE(driver->Next(batch));
    for (const sensing::MargSample& sample : batch.marg) {
      EXPECT_EQ(
          sample.flags & (sensing::kCoilPulseActive | sensing::kAnyCoilOn | sensing::kCoilReversed),
          expected);
    }
  }
}

TEST(CoilPulseDriverTest, ACurrentThatIsMissingOrFivePercentOffMasksThePulse) {
  for (const double current_a :
       {1.5 * 1.06, 1.5 * 0.94, std::numeric_limits<double>::quiet_NaN()}) {
    const auto driver = Fake([&](Batch& batch) {
      batch.coil_drives.push_back(
          {.source_uid = {1}, .drive = {.coil = 0, .current_a = current_a}});
    });
    Batch batch;
    ASSERT_TRUE(driver->Next(batch));
    EXPECT_FALSE(sensing::CoilDriveOf(batch.marg[1].flags, 1.5).settled) << current_a;
  }
}

TEST(CoilPulseDriverTest, ASourceThatDoesNotSpeakMasksEverything) {
  const auto driver = Fake([](Batch&) {});
  Batch batch;
  ASSERT_TRUE(driver->Next(batch));
  EXPECT_EQ(batch.marg[1].flags & (sensing::kCoilPulseActive | sensing::kAnyCoilOn),
            sensing::kCoilPulseActive);
}

TEST(CoilPulseDriverTest, PulsesOfAnotherSlotAreMaskedAndOnlyThose) {
  const auto driver = Make(Walking(2));
  Batch batch;
  int own = 0;
  int foreign = 0;
  for (int tick = 0; tick < 300; ++tick) {
    ASSERT_TRUE(driver->Next(batch));
    const auto& first = batch.coil_drives[0].drive;
    const auto& second = batch.coil_drives[1].drive;
    const auto seen = sensing::CoilDriveOf(batch.marg[0].flags, 1.5);
    const bool second_active = second.coil >= 0 || !second.settled;
    EXPECT_EQ(seen.settled, first.settled && !second_active);
    own += seen.coil >= 0 ? 1 : 0;
    foreign += second_active ? 1 : 0;
  }
  EXPECT_GT(own, 50);
  EXPECT_GT(foreign, 50);
}

TEST(CoilPulseDriverTest, SlotsOfOtherGatewaysAreMaskedWhole) {
  const auto driver =
      Fake([](Batch& batch) { batch.coil_drives.push_back({.source_uid = {1}, .drive = {}}); });
  CoilSchedule schedule;
  schedule.own = {{.body_id = {1}, .grant = sensing::CoilGrant{.slot = 0, .slots = 2}}};
  schedule.foreign = {sensing::CoilGrant{.slot = 1, .slots = 2}};
  schedule.to_host = std::chrono::milliseconds(1'000'030);  // 30 ms into a frame of 200 ms
  ASSERT_TRUE(driver->FollowSlots(schedule).ok());
  Batch batch;
  int masked = 0;
  for (int tick = 0; tick < 40; ++tick) {
    ASSERT_TRUE(driver->Next(batch));
    const bool foreign = (30 + 10 * tick) % 200 >= 100;
    masked += foreign ? 1 : 0;
    for (const sensing::MargSample& sample : batch.marg) {
      EXPECT_EQ(sample.flags & (sensing::kCoilPulseActive | sensing::kAnyCoilOn),
                foreign ? static_cast<std::uint32_t>(sensing::kCoilPulseActive) : 0U)
          << tick;
    }
  }
  EXPECT_EQ(masked, 20);
}

// The amplitude of each pulse of a walking person against the exact field at the true pose.
TEST(CoilPulseDriverTest, PulsesOfAWalkingPersonAreTheFieldOfTheCoils) {
  const auto driver = Make(Walking());
  Batch batch;
  std::map<std::pair<std::uint64_t, std::int64_t>, body::SegmentTruth> truths;
  int pulses = 0;
  double sum_nis = 0.0;
  SensorUid source{};
  for (int tick = 0; tick < 800; ++tick) {
    ASSERT_TRUE(driver->Next(batch));
    source = batch.coil_drives[0].source_uid;
    for (const auto& truth : batch.truth) {
      truths[{truth.sensor_uid.value, ToNanoseconds(truth.measured_at)}] = truth;
    }
    for (const sensing::CoilBurst& burst : batch.coil_bursts) {
      const std::int64_t at = ToNanoseconds(burst.measured_at);
      const auto& sensor = truths.at({burst.sensor_uid.value, at});
      const auto& emitter = truths.at({source.value, at});
      const Eigen::Vector3d p_M =
          emitter.q_earth_sensor.conjugate() * (sensor.p_earth_sensor_m - emitter.p_earth_sensor_m);
      for (int coil = 0; coil < 3; ++coil) {
        const auto& pulse = burst.pulses[static_cast<std::size_t>(coil)];
        if (pulse.off_at == Time{}) {
          EXPECT_FALSE(pulse.valid);
          continue;
        }
        ++pulses;
        EXPECT_GT(pulse.off_at, burst.measured_at);
        EXPECT_LT(pulse.on_at, burst.measured_at);
        EXPECT_FLOAT_EQ(pulse.current_a, 1.5F);
        const Eigen::Vector3d field_S =
            sensor.q_earth_sensor.conjugate() * emitter.q_earth_sensor *
            sensing::CoilField({}, coil, pulse.current_a, p_M).field_tesla;
        const Eigen::Vector3d off_S = pulse.field_tesla.cast<double>() - field_S;
        // What moving during the pulse leaves comes on top of the noise.
        sum_nis += off_S.squaredNorm() / 3.0 /
                   (pulse.sigma_tesla * pulse.sigma_tesla + 0.04 * 0.04 * field_S.squaredNorm());
      }
    }
  }
  EXPECT_GT(pulses, 4 * 35);
  EXPECT_LT(sum_nis / pulses, 2.0);
}

TEST(CoilPulseDriverTest, AfterRewindItBeginsAnew) {
  SimulatorConfig config = Walking();
  config.duration_s = 2.0;
  const auto driver = Make(config);
  const auto count = [&] {
    Batch batch;
    std::vector<std::uint32_t> sequences;
    while (*driver->Next(batch) == DriverStep::kData) {
      for (const auto& burst : batch.coil_bursts) {
        sequences.push_back(burst.sequence);
      }
    }
    return sequences;
  };
  const auto first = count();
  ASSERT_FALSE(first.empty());
  ASSERT_TRUE(driver->Rewind());
  EXPECT_EQ(count(), first);
}

}  // namespace
}  // namespace limbcast::gateway
