// The hot path allocates nothing after the start. An executable of its own, because it replaces the
// global operator new.
#include <gtest/gtest.h>

#include <memory>
#include <span>
#include <string>
#include <vector>

#include "common/bus/segment_state_reader.hpp"
#include "services/fusion/fusion_service.hpp"
#include "tests/support/allocation_counter.hpp"
#include "tests/support/position_run.hpp"
#include "tests/unit/services/fusion/fusion_fixture.hpp"

namespace limbcast::fusion {
namespace {

TEST(FusionAllocationTest, TheCounterSeesAnAllocation) {
  const std::size_t before = test_support::AllocationCount();
  const auto memory = std::make_unique<int>(1);
  EXPECT_EQ(test_support::AllocationCount(), before + 1) << *memory;
}

class FusionWaysOutTest : public ::testing::TestWithParam<bool> {};
INSTANTIATE_TEST_SUITE_P(Published, FusionWaysOutTest, ::testing::Bool(), [](const auto& test) {
  return std::string(test.param ? "as_frames" : "alone");
});

TEST_P(FusionWaysOutTest, NoAllocationFromSampleToStateAfterTheStart) {
  test_support::FakeClock clock;
  const auto hub = bus::inproc::MakeHub(&clock);
  const auto outside = bus::inproc::MakeBus(hub);
  const auto inside = bus::inproc::MakeBus(hub);
  test_support::ImmediatePool pool;
  FusionConfig config;
  config.filter.beside = "tqt";
  config.segment_frame = GetParam();
  FusionService service(config, clock, *inside, pool);  // with the shipped filter
  ASSERT_TRUE(service.Start().ok());
  std::uint64_t states = 0;
  const auto reader = *bus::SegmentStateReader::Make(
      *outside, [&](std::span<const body::SegmentState> several, const bus::SampleInfo&) {
        states += several.size();
      });
  const auto roster = *outside->MakeWriter<roster::RosterEntry>();
  roster::RosterEntry entry;
  entry.body_id = BodyId{1};
  entry.sensors = {{SensorUid{10}, body::Segment::kHead}};
  ASSERT_TRUE(roster->Write(entry).ok());
  const auto marg = *outside->MakeWriter<sensing::MargSample>();
  const auto frames = *outside->MakeWriter<sensing::MargFrame>();
  const auto orientations = *outside->MakeWriter<sensing::FusedOrientation>();

  sensing::MargSample sample;
  sample.sensor_uid = SensorUid{10};
  sample.accel_m_s2.z() = 9.81F;
  sample.mag_tesla = {0.0F, 2e-5F, -4e-5F};
  sensing::MargFrame frame;
  frame.body_id = BodyId{1};
  frame.samples = {sample};
  sensing::FusedOrientation orientation;
  orientation.sensor_uid = SensorUid{10};
  std::size_t allocations_at_start = 0;
  for (std::uint32_t i = 1; i <= 1'000; ++i) {
    if (i == 101) {
      allocations_at_start = test_support::AllocationCount();
    }
    sample.sequence = 2 * i - 1;
    sample.measured_at = clock.Now();
    ASSERT_TRUE(marg->Write(sample).ok());
    clock.Advance(std::chrono::milliseconds(5));
    frame.samples[0].sequence = 2 * i;
    frame.samples[0].measured_at = clock.Now();
    ASSERT_TRUE(frames->Write(frame).ok());
    ASSERT_TRUE(frames->Write(frame).ok());  // refused as a duplicate
    orientation.sequence = i;
    orientation.measured_at = clock.Now();
    ASSERT_TRUE(orientations->Write(orientation).ok());
    clock.Advance(std::chrono::milliseconds(5));
  }
  EXPECT_EQ(test_support::AllocationCount(), allocations_at_start);
  EXPECT_EQ(states, 1'000U * 3U * 2U);
  EXPECT_EQ(service.counters().verdicts[SampleVerdict::kRejectedDuplicate], 1'000U);
}

// Neither the first pulse, nor the first marker, nor the start of a track.
TEST(FusionAllocationTest, PositionsAllocateWithTheRosterOnly) {
  gateway::SimulatorConfig simulator = test_support::CoilPeople();
  simulator.n_pose_s = 1.0;
  simulator.cameras.markers = {body::Segment::kPelvis};
  const auto driver = gateway::WithCoilPulses(*gateway::SimulatorDriver::Make(simulator));
  test_support::FakeClock clock;
  const Time start = clock.Now();
  constexpr std::size_t kTicks = 700;
  std::vector<gateway::Batch> batches(kTicks);
  for (std::size_t tick = 0; tick < kTicks; ++tick) {
    gateway::Batch& batch = batches[tick];
    ASSERT_TRUE(driver->Next(batch));
    for (sensing::MargSample& sample : batch.marg) {
      sample.sequence = static_cast<std::uint32_t>(tick + 1);
      sample.measured_at += start.time_since_epoch();
    }
    for (sensing::MarkerPosition& marker : batch.markers) {
      marker.measured_at += start.time_since_epoch();
    }
  }
  const auto hub = bus::inproc::MakeHub(&clock);
  const auto outside = bus::inproc::MakeBus(hub);
  const auto inside = bus::inproc::MakeBus(hub);
  test_support::ImmediatePool pool;
  FusionConfig config;
  config.position = test_support::CoilAid();
  config.position.markers.segments = {body::Segment::kPelvis};
  config.position.lag_s = 0.5;
  FusionService service(config, clock, *inside, pool);
  ASSERT_TRUE(service.Start().ok());
  const auto roster = *outside->MakeWriter<roster::RosterEntry>();
  ASSERT_TRUE(roster->Write(driver->Describe().bodies[0]).ok());
  const auto marg = *outside->MakeWriter<sensing::MargSample>();
  const auto markers = *outside->MakeWriter<sensing::MarkerPosition>();
  constexpr std::size_t kBeforeTheFirstPulse = 40;
  std::size_t allocations_at_start = 0;
  for (std::size_t tick = 0; tick < kTicks; ++tick) {
    if (tick == kBeforeTheFirstPulse) {
      EXPECT_LT(service.counters().positions, 2 * kBeforeTheFirstPulse);
      allocations_at_start = test_support::AllocationCount();
    }
    clock.Advance(std::chrono::milliseconds(10));
    for (const sensing::MarkerPosition& marker : batches[tick].markers) {
      ASSERT_TRUE(markers->Write(marker).ok());
    }
    for (const sensing::MargSample& sample : batches[tick].marg) {
      ASSERT_TRUE(marg->Write(sample).ok());
    }
  }
  // The bus makes room for the lagged instance of each of five sensors when it hears of it first.
  EXPECT_EQ(test_support::AllocationCount(), allocations_at_start + 5);
  EXPECT_GT(service.counters().positions, 3 * 200U) << "the pelvis, and limbs in motion";
}

}  // namespace
}  // namespace limbcast::fusion
