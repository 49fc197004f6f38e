// The way from state to skeleton allocates nothing after the first ticks. An executable of its own,
// because it replaces the global operator new.
#include <gtest/gtest.h>

#include <memory>
#include <vector>

#include "tests/support/allocation_counter.hpp"
#include "tests/unit/services/posture/posture_rig.hpp"

namespace limbcast::posture {
namespace {

using namespace std::chrono_literals;

constexpr BodyId kBody{1};

TEST(PostureAllocationTest, TheCounterSeesAnAllocation) {
  const std::size_t before = test_support::AllocationCount();
  const auto memory = std::make_unique<int>(1);
  EXPECT_EQ(test_support::AllocationCount(), before + 1) << *memory;
}

TEST(PostureAllocationTest, ASteadyStreamDoesNotAllocateFromStateToSkeleton) {
  test_support::FakeClock clock;
  const auto hub = bus::inproc::MakeHub(&clock);
  const auto outside = bus::inproc::MakeBus(hub);
  const auto inside = bus::inproc::MakeBus(hub);
  test_support::ImmediatePool pool;
  PostureConfig config;
  config.joint_limits = true;
  PostureService service(config, clock, *inside, pool);
  ASSERT_TRUE(service.Start().ok());
  std::size_t skeletons = 0;
  std::uint32_t contacts = 0;
  const auto reader = *outside->MakeReader<body::Skeleton>(
      {.on_sample =
           [&](const body::Skeleton& skeleton, const bus::SampleInfo&) {
             ++skeletons;
             contacts = skeleton.contacts;
           },
       .on_disposed = {}});
  std::size_t angles = 0;
  const auto angle_reader = *outside->MakeReader<body::JointAngleFrame>(
      {.on_sample = [&](const body::JointAngleFrame&, const bus::SampleInfo&) { ++angles; },
       .on_disposed = {}});
  const auto rosters = *outside->MakeWriter<roster::RosterEntry>();
  const auto states = *outside->MakeWriter<body::SegmentState>();
  const std::vector<body::Segment> all(body::AllSegments().begin(), body::AllSegments().end());
  ASSERT_TRUE(rosters->Write(MakeRoster(kBody, all)).ok());
  std::vector<body::SegmentState> tick;
  for (const body::Segment segment : all) {
    tick.push_back(MakeState(kBody, segment, clock.Now()));
  }
  const auto run = [&](int ticks) {
    for (int i = 0; i < ticks; ++i) {
      clock.Advance(10ms);
      pool.RunDue(clock.Now());
      const bool lossy = i % 5 == 0;  // some end by the deadline
      for (std::size_t s = lossy ? 1 : 0; s < tick.size(); ++s) {
        tick[s].measured_at = clock.Now();
        (void)states->Write(tick[s]);
      }
    }
    clock.Advance(10ms);
    pool.RunDue(clock.Now());
  };
  run(100);
  // Aligned, so that the contacts of the feet are looked for.
  roster::Command command;
  command.body_id = kBody;
  command.kind = roster::CommandKind::kReferencePose;
  ASSERT_TRUE((*outside->MakeWriter<roster::Command>())->Write(command).ok());
  run(20);
  ASSERT_NE(contacts, 0U);
  const std::size_t before = test_support::AllocationCount();
  run(200);
  EXPECT_EQ(test_support::AllocationCount() - before, 0U);
  EXPECT_EQ(skeletons, 320U);
  EXPECT_EQ(angles, 320U);
}

}  // namespace
}  // namespace limbcast::posture
