#include "services/fusion/fusion_service.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <limits>
#include <random>

#include "tests/unit/services/fusion/fusion_fixture.hpp"

namespace limbcast::fusion {
namespace {

using ::testing::Contains;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::Pair;

class FusionServiceTest : public ::testing::Test {
 protected:
  FusionServiceTest() {
    const Status started = service.Start();
    EXPECT_TRUE(started.ok());
  }
  double Value(const std::string& name) {
    ServiceHealth health;
    service.FillHealth(health);
    for (const NamedValue& value : health.values) {
      if (value.name == name) {
        return value.value;
      }
    }
    ADD_FAILURE() << "no value " << name;
    return -1.0;
  }

  FusionWorld world;
  test_support::ImmediatePool pool{2};
  FusionService service{CountingConfig(), world.clock, *world.inside, pool, CountingFilters()};
};

TEST_F(FusionServiceTest, EverySampleOfAnAssignedSensorIsAnsweredByOneState) {
  world.Assign(1, {{10, body::Segment::kHead}, {11, body::Segment::kPelvis}});
  for (std::uint32_t i = 1; i <= 50; ++i) {
    world.Send(world.Sample(10, i));
    world.Send(world.Sample(11, i));
  }
  ASSERT_EQ(world.states.size(), 100U);
  for (std::size_t i = 0; i < world.states.size(); ++i) {
    EXPECT_EQ(world.states[i].sequence, i / 2 + 1);
    EXPECT_EQ(world.states[i].verdict, SampleVerdict::kFused);
  }
  EXPECT_EQ(service.counters().received, 100U);
  EXPECT_EQ(service.counters().verdicts.used(), 100U);
  EXPECT_EQ(service.counters().published, 100U);
}

TEST_F(FusionServiceTest, AnUnassignedSensorIsCountedAndAnsweredOnceItIsAssigned) {
  world.Send(world.Sample(10, 1));
  EXPECT_TRUE(world.states.empty());
  EXPECT_EQ(service.counters().verdicts[SampleVerdict::kRejectedUnassigned], 1U);
  world.Assign(1, {{10, body::Segment::kHead}});
  world.Send(world.Sample(10, 2));
  ASSERT_EQ(world.states.size(), 1U);
  EXPECT_EQ(world.last().lost_count, 0U);
  EXPECT_EQ(service.counters().received, 2U);
}

TEST_F(FusionServiceTest, AProbeIsAnsweredAndNotASample) {
  world.Assign(1, {{10, body::Segment::kHead}});
  sensing::MargSample probe = world.Sample(10, 0);
  probe.flags =
      sensing::kProbe | sensing::kGyroMissing | sensing::kAccelMissing | sensing::kMagMissing;
  world.Send(probe);
  ASSERT_EQ(world.states.size(), 1U);
  EXPECT_EQ(world.last().verdict, SampleVerdict::kNoData);
  EXPECT_FALSE(world.last().started);
  probe.sensor_uid = SensorUid{99};
  world.Send(probe);
  EXPECT_EQ(service.counters().received, 0U);
  EXPECT_EQ(service.counters().probes, 2U);
}

TEST_F(FusionServiceTest, AFrameGivesTheSameStatesAsItsSamples) {
  world.Assign(1, {{10, body::Segment::kHead}, {11, body::Segment::kPelvis}});
  world.Assign(2, {{20, body::Segment::kHead}, {21, body::Segment::kPelvis}});
  std::mt19937 rng(7);
  std::uniform_real_distribution<float> rate(-0.2F, 0.2F);
  for (std::uint32_t i = 1; i <= 100; ++i) {
    sensing::MargFrame frame;
    frame.body_id = BodyId{2};
    for (const std::uint64_t uid : {std::uint64_t{10}, std::uint64_t{11}}) {
      sensing::MargSample sample = world.Sample(uid, i);
      sample.gyro_rad_s.x() = i % 17 == 0 ? std::numeric_limits<float>::infinity() : rate(rng);
      world.Send(sample);
      sample.sensor_uid = SensorUid{uid + 10};
      frame.samples.push_back(sample);
    }
    EXPECT_TRUE(world.frame->Write(frame).ok());
  }
  std::vector<body::SegmentState> of_samples;
  std::vector<body::SegmentState> of_frames;
  for (const body::SegmentState& state : world.states) {
    (state.body_id == BodyId{1} ? of_samples : of_frames).push_back(state);
  }
  ASSERT_EQ(of_samples.size(), 200U);
  ASSERT_EQ(of_frames.size(), 200U);
  for (std::size_t i = 0; i < of_samples.size(); ++i) {
    EXPECT_EQ(of_frames[i].sequence, of_samples[i].sequence);
    EXPECT_EQ(of_frames[i].segment, of_samples[i].segment);
    EXPECT_EQ(of_frames[i].verdict, of_samples[i].verdict);
    EXPECT_TRUE(of_frames[i].q_earth_sensor.isApprox(of_samples[i].q_earth_sensor, 0.0));
    EXPECT_EQ(of_frames[i].verdicts, of_samples[i].verdicts);
  }
}

TEST_F(FusionServiceTest, VerdictsOfRefusedSamplesReachHealth) {
  world.Assign(1, {{10, body::Segment::kHead}});
  world.Send(world.Sample(10, 1));
  sensing::MargSample nan = world.Sample(10, 2);
  nan.gyro_rad_s.z() = std::numeric_limits<float>::quiet_NaN();
  world.Send(nan);
  world.Send(world.Sample(10, 1));
  world.Send(world.Sample(10, 6));
  sensing::MargSample late = world.Sample(10, 4);
  world.Send(late);
  sensing::MargSample future = world.Sample(10, 7);
  future.measured_at += std::chrono::hours(48);
  world.Send(future);
  world.Send(world.Sample(99, 1));
  EXPECT_EQ(Value("samples.received"), 7.0);
  EXPECT_EQ(Value("samples.used"), 2.0);
  EXPECT_EQ(Value("samples.lost"), 2.0);  // 3 and 5; 4 came late
  EXPECT_EQ(Value("verdict.not_finite"), 1.0);
  EXPECT_EQ(Value("verdict.duplicate"), 1.0);
  EXPECT_EQ(Value("verdict.out_of_order"), 1.0);
  EXPECT_EQ(Value("verdict.time"), 1.0);
  EXPECT_EQ(Value("verdict.unassigned"), 1.0);
  EXPECT_EQ(Value("gauge.bodies"), 1.0);
  EXPECT_EQ(Value("gauge.marg_writers"), 1.0);
  EXPECT_EQ(world.states.size(), 6U) << "every one of the assigned sensor was answered";
}

TEST_F(FusionServiceTest, ASensorMovesToAnotherSegmentAndItsOldOneEnds) {
  world.Assign(1, {{10, body::Segment::kHead}});
  world.Send(world.Sample(10, 1));
  world.Assign(1, {{10, body::Segment::kNeck}});
  world.Send(world.Sample(10, 2));
  EXPECT_THAT(world.disposed, ElementsAre(Pair(body::Segment::kHead, 0)));
  EXPECT_EQ(world.last().segment, body::Segment::kNeck);
  EXPECT_EQ(world.last().verdicts.used(), 2U) << "the filter goes on";
}

TEST_F(FusionServiceTest, ASensorMovesToAnotherBodyOnAnotherWorker) {
  world.Assign(1, {{10, body::Segment::kHead}});
  world.Send(world.Sample(10, 1));
  world.Assign(2, {{10, body::Segment::kHead}});
  world.Send(world.Sample(10, 2));
  EXPECT_THAT(world.disposed, ElementsAre(Pair(body::Segment::kHead, 0)));
  EXPECT_EQ(world.last().body_id, BodyId{2});
  EXPECT_EQ(world.last().sequence, 2U);
}

TEST_F(FusionServiceTest, ABodyThatIsDisposedOfEnds) {
  world.Assign(1, {{10, body::Segment::kHead}, {11, body::Segment::kPelvis}});
  world.Send(world.Sample(10, 1));
  world.Send(world.Sample(11, 1));
  roster::RosterEntry key;
  key.body_id = BodyId{1};
  EXPECT_TRUE(world.roster->Dispose(key).ok());
  EXPECT_EQ(world.disposed.size(), 2U);
  world.Send(world.Sample(10, 2));
  EXPECT_EQ(world.states.size(), 2U);
  EXPECT_EQ(Value("verdict.unassigned"), 1.0);
  EXPECT_EQ(Value("gauge.bodies"), 0.0);
}

TEST_F(FusionServiceTest, ACommandSelectsAFilterAndIsAnswered) {
  world.Assign(1, {{10, body::Segment::kHead}, {11, body::Segment::kPelvis}});
  roster::Command command;
  command.client_uid = 5;
  command.request_id = 6;
  command.body_id = BodyId{1};
  command.kind = roster::CommandKind::kSelectFilter;
  command.text = "slow";
  command.numbers = {static_cast<double>(body::Segment::kHead)};
  EXPECT_TRUE(world.command->Write(command).ok());
  ASSERT_EQ(world.replies.size(), 1U);
  EXPECT_TRUE(world.replies[0].accepted);
  EXPECT_EQ(world.replies[0].client_uid, 5U);
  EXPECT_EQ(world.replies[0].request_id, 6U);
  world.Send(world.Sample(10, 1));
  EXPECT_EQ(world.last().filter, "slow");
  world.Send(world.Sample(11, 1));
  EXPECT_EQ(world.last().filter, "tqt");

  command.request_id = 7;
  command.text = "beside slow";
  command.numbers.clear();
  command.body_id = BodyId{0};
  EXPECT_TRUE(world.command->Write(command).ok());
  world.Send(world.Sample(11, 2));
  EXPECT_EQ(world.last().slot, 1);
  EXPECT_EQ(world.last().filter, "slow");
  command.request_id = 8;
  command.text = "beside none";
  EXPECT_TRUE(world.command->Write(command).ok());
  EXPECT_THAT(world.disposed, Contains(Pair(body::Segment::kPelvis, 1)));
  world.Send(world.Sample(11, 3));
  EXPECT_EQ(world.last().slot, 0);
}

TEST_F(FusionServiceTest, ARepeatedCommandIsAnsweredAgainAndDoneOnce) {
  world.Assign(1, {{10, body::Segment::kHead}});
  roster::Command command;
  command.client_uid = 5;
  command.request_id = 6;
  command.body_id = BodyId{1};
  command.kind = roster::CommandKind::kSelectFilter;
  command.text = "slow";
  EXPECT_TRUE(world.command->Write(command).ok());
  // Under the same number it is the same request, whatever else is in it.
  command.text = "tqt";
  EXPECT_TRUE(world.command->Write(command).ok());
  ASSERT_EQ(world.replies.size(), 2U);
  EXPECT_EQ(world.replies[1].request_id, 6U);
  EXPECT_EQ(world.replies[1].message, world.replies[0].message);
  world.Send(world.Sample(10, 1));
  EXPECT_EQ(world.last().filter, "slow");
}

TEST_F(FusionServiceTest, ACommandThatCannotBeIsRefusedWithTheReason) {
  world.Assign(1, {{10, body::Segment::kHead}});
  roster::Command command;
  command.kind = roster::CommandKind::kSelectFilter;
  command.request_id = 1;
  command.text = "nonesuch";
  EXPECT_TRUE(world.command->Write(command).ok());
  command.request_id = 2;
  command.text = "tqt";
  command.numbers = {23.0};
  EXPECT_TRUE(world.command->Write(command).ok());
  command.request_id = 3;
  command.numbers.clear();
  command.body_id = BodyId{9};
  EXPECT_TRUE(world.command->Write(command).ok());
  ASSERT_EQ(world.replies.size(), 3U);
  for (const roster::CommandReply& reply : world.replies) {
    EXPECT_FALSE(reply.accepted);
  }
  EXPECT_THAT(world.replies[0].message, HasSubstr("nonesuch"));
  EXPECT_EQ(world.replies[1].message, "segment must be a whole number in [0, 22], is 23");
  EXPECT_EQ(world.replies[2].message, "body 9 is not in the roster");
  command.kind = roster::CommandKind::kResetHeading;
  EXPECT_TRUE(world.command->Write(command).ok());
  EXPECT_EQ(world.replies.size(), 3U) << "that one is for posture";
}

TEST_F(FusionServiceTest, HealthHasTheLatencyStages) {
  world.Assign(1, {{10, body::Segment::kHead}});
  world.Send(world.Sample(10, 1));
  ServiceHealth health;
  service.FillHealth(health);
  std::vector<std::string> stages;
  for (const LatencyQuantiles& latency : health.latencies) {
    stages.push_back(latency.stage);
    EXPECT_EQ(latency.count, 1U) << latency.stage;
  }
  EXPECT_THAT(stages, ElementsAre("gateway_to_fusion", "fusion_queue", "fusion_step", "fusion"));
  EXPECT_LE(health.values.size(), 96U) << "bound of the wire type";
}

/// A pool whose workers do nothing until told: the queues fill.
class HeldPool final : public runtime::WorkerPool {
 public:
  [[nodiscard]] std::size_t size() const override { return 1; }
  void Start(Drain drain) override { drain_ = std::move(drain); }
  void Wake(std::size_t) override {}
  void Stop() override { Run(); }
  void Run() { drain_(0); }

 private:
  Drain drain_;
};

TEST(FusionOverloadTest, SamplesThatFindTheQueueFullAreCountedAndNotLost) {
  FusionWorld world;
  HeldPool pool;
  FusionConfig config = CountingConfig();
  config.queue_capacity = 64;
  FusionService service(config, world.clock, *world.inside, pool, CountingFilters());
  ASSERT_TRUE(service.Start().ok());
  world.Assign(1, {{10, body::Segment::kHead}});
  for (std::uint32_t i = 1; i <= 100; ++i) {
    world.Send(world.Sample(10, i));
  }
  const std::uint64_t refused = service.counters().verdicts[SampleVerdict::kRejectedOverload];
  EXPECT_GT(refused, 0U);
  pool.Run();
  EXPECT_EQ(world.states.size() + refused, 100U);
  world.Send(world.Sample(10, 101));
  pool.Run();
  EXPECT_EQ(world.last().sequence, 101U);
  EXPECT_EQ(world.last().verdicts[SampleVerdict::kRejectedOverload], refused);
  EXPECT_EQ(world.last().lost_count, 0U);
  EXPECT_EQ(service.counters().lost, 0);
  EXPECT_EQ(service.counters().received, 101U);
  EXPECT_GT(service.counters().queue_high_water, 0U);
}

TEST(FusionStartTest, StopWithoutStartAndStopTwiceDoNothing) {
  FusionWorld world;
  test_support::ImmediatePool pool;
  FusionService service(CountingConfig(), world.clock, *world.inside, pool, CountingFilters());
  service.Stop();
  ASSERT_TRUE(service.Start().ok());
  service.Stop();
  service.Stop();
  ServiceHealth health;
  service.FillHealth(health);
  EXPECT_FALSE(health.values.empty());
}

}  // namespace
}  // namespace limbcast::fusion
