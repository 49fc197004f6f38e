#include "services/fusion/body_positions.hpp"

#include <gtest/gtest.h>

#include "tests/support/position_run.hpp"
#include "tests/unit/services/fusion/fusion_fixture.hpp"

namespace limbcast::fusion {
namespace {

using body::Segment;

BodyPlan PlanOf(const std::vector<std::pair<std::uint64_t, Segment>>& sensors) {
  BodyPlan plan{.body_id = BodyId{1}, .tracks = {}};
  for (const auto& [uid, segment] : sensors) {
    plan.tracks.push_back({.sensor_uid = {uid}, .segment = segment, .filters = {}});
  }
  return plan;
}

TEST(BodyPositionsTest, OnlyWhatIsWornAndNamedHasATrack) {
  const PositionConfig config = test_support::CoilAid();
  BodyPositions positions(config);
  positions.Apply(PlanOf({{1, Segment::kPelvis}, {2, Segment::kHead}}));
  EXPECT_TRUE(positions.empty());
  positions.Apply(PlanOf({{1, Segment::kPelvis}, {2, Segment::kLeftForeArm}}));
  EXPECT_FALSE(positions.empty());
  positions.Apply(PlanOf({{2, Segment::kLeftForeArm}}));
  EXPECT_TRUE(positions.empty()) << "nobody wears the coils";
}

TEST(BodyPositionsTest, ARefusedSampleHasNoPositionAndMovesNothing) {
  const PositionConfig config = test_support::CoilAid();
  BodyPositions positions(config);
  positions.Apply(PlanOf({{1, Segment::kPelvis}, {2, Segment::kLeftForeArm}}));
  body::SegmentState state;
  state.verdict = SampleVerdict::kRejectedDuplicate;
  state.has_position = true;  // left from the sample before
  state.position_fill = FillKind::kMeasured;
  positions.Update({.sensor_uid = {2}}, state);
  EXPECT_FALSE(state.has_position);
  EXPECT_EQ(state.position_fill, FillKind::kNone);
}

// The service as a whole: markers and coils of a simulated person through the bus.
TEST(BodyPositionsTest, TheServicePublishesPositionsThatDoNotDependOnItsWorkers) {
  const auto run = [](std::size_t workers) {
    FusionWorld world;
    test_support::ImmediatePool pool(workers);
    FusionConfig config;
    config.position = test_support::CoilAid();
    config.position.markers.segments = {Segment::kPelvis};
    FusionService service(config, world.clock, *world.inside, pool);
    EXPECT_TRUE(service.Start());
    gateway::SimulatorConfig simulator = test_support::CoilPeople(2);
    simulator.n_pose_s = 1.0;
    simulator.cameras.markers = {Segment::kPelvis};
    const auto driver = gateway::WithCoilPulses(*gateway::SimulatorDriver::Make(simulator));
    for (const roster::RosterEntry& entry : driver->Describe().bodies) {
      EXPECT_TRUE(world.roster->Write(entry));
    }
    const auto markers = *world.outside->MakeWriter<sensing::MarkerPosition>();
    gateway::Batch batch;
    std::uint32_t sequence = 0;
    for (int tick = 0; tick < 700; ++tick) {
      EXPECT_TRUE(driver->Next(batch));
      const Duration since_start = batch.tick_at.time_since_epoch();
      world.clock.Set(world.start + since_start + kPeriod);
      for (sensing::MarkerPosition& marker : batch.markers) {
        marker.measured_at += world.start.time_since_epoch();
        EXPECT_TRUE(markers->Write(marker));
      }
      ++sequence;
      for (sensing::MargSample& sample : batch.marg) {
        sample.sequence = sequence;
        sample.measured_at += world.start.time_since_epoch();
        world.Send(sample);
      }
    }
    EXPECT_GT(service.counters().positions, 2U * 300U);
    std::map<std::pair<std::uint32_t, Segment>, std::vector<body::SegmentState>> states;
    for (const body::SegmentState& state : world.states) {
      states[{state.body_id.value, state.segment}].push_back(state);
    }
    service.Stop();
    return states;
  };
  const auto one = run(1);
  const auto two = run(2);
  ASSERT_EQ(one.size(), 34U);
  for (const auto& [key, states] : one) {
    const auto& others = two.at(key);
    ASSERT_EQ(states.size(), others.size());
    for (std::size_t i = 0; i < states.size(); ++i) {
      EXPECT_EQ(states[i].has_position, others[i].has_position);
      EXPECT_EQ(states[i].p_earth_sensor_m, others[i].p_earth_sensor_m);
    }
    const body::SegmentState& last = states.back();
    const bool wrist = key.second == Segment::kRightForeArm || key.second == Segment::kLeftForeArm;
    if (key.second == Segment::kPelvis) {
      EXPECT_TRUE(last.has_position);
      EXPECT_EQ(last.position_reference, PositionReference::kEarth);
    } else if (wrist) {
      EXPECT_TRUE(last.has_position);
      EXPECT_EQ(last.position_reference, PositionReference::kSensor);
      EXPECT_EQ(last.position_from, Segment::kPelvis);
      EXPECT_LT(last.p_earth_sensor_m.norm(), 1.0F);
      EXPECT_GT(last.cov_position_m2.trace(), 0.0F);
    } else if (key.second == Segment::kHead) {
      EXPECT_FALSE(last.has_position);
    }
  }
}

}  // namespace
}  // namespace limbcast::fusion
