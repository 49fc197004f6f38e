#include "services/gateway/flow_control.hpp"

#include <gtest/gtest.h>

#include "tests/unit/services/gateway/fake_driver.hpp"

namespace limbcast::gateway {
namespace {

using namespace std::chrono_literals;

constexpr Time kNow = TimeFromNanoseconds(1'700'000'000'000'000'000);

class FlowControlTest : public ::testing::Test {
 protected:
  FlowControlTest() {
    config_.pace.as_fast = true;
    config_.window_ticks = 2;
    config_.answer_timeout_s = 1.0;
    streams_ = {{.uid = SensorUid{1}, .label = "a", .body = 0},
                {.uid = SensorUid{2}, .label = "b", .body = 0}};
  }
  FlowControl Make() { return {config_, driver_.Describe()}; }

  // Sends one sample of both sensors.
  void SendTick(FlowControl& flow, std::uint32_t sequence, Time now) {
    Batch batch;
    for (const SensorStream& stream : streams_) {
      batch.marg.emplace_back();
      batch.marg.back().sensor_uid = stream.uid;
      batch.marg.back().sequence = sequence;
      batch.marg.back().measured_at = TickTime(sequence);
    }
    flow.Sent(batch, streams_, {0, 1}, {}, now);
  }
  static Time TickTime(std::uint32_t sequence) { return kNow + sequence * 10ms; }
  static bool Answer(FlowControl& flow, std::uint64_t uid, std::uint32_t sequence) {
    body::SegmentState state;
    state.sensor_uid = SensorUid{uid};
    state.sequence = sequence;
    state.measured_at = TickTime(sequence);
    return flow.OnState(state);
  }

  GatewayConfig config_;
  test::FakeDriver driver_{2};
  std::vector<SensorStream> streams_;
};

TEST_F(FlowControlTest, HoldsWhenOneSensorIsAWindowBehind) {
  FlowControl flow = Make();
  SendTick(flow, 1, kNow);
  Answer(flow, 1, 1);
  EXPECT_EQ(flow.Full(kNow), std::nullopt);
  SendTick(flow, 2, kNow);
  EXPECT_EQ(flow.Full(kNow), kNow + 1s);  // sensor 2 has not answered 1 and 2
  EXPECT_TRUE(Answer(flow, 2, 1));        // wakes the waiting worker
  EXPECT_EQ(flow.Full(kNow), std::nullopt);
}

TEST_F(FlowControlTest, WakesNobodyWhoIsNotWaiting) {
  FlowControl flow = Make();
  SendTick(flow, 1, kNow);
  EXPECT_FALSE(Answer(flow, 1, 1));
}

TEST_F(FlowControlTest, UnansweredSamplesAreCountedAndDoNotHoldForever) {
  FlowControl flow = Make();
  SendTick(flow, 1, kNow);
  SendTick(flow, 2, kNow);
  Answer(flow, 1, 1);
  Answer(flow, 1, 2);
  ASSERT_TRUE(flow.Full(kNow).has_value());
  EXPECT_EQ(flow.Full(kNow + 1s), std::nullopt);
  EXPECT_EQ(flow.counters().samples_unanswered, 2U);
  EXPECT_EQ(flow.unanswered(SensorUid{1}), 0U);
  EXPECT_EQ(flow.unanswered(SensorUid{2}), 2U);
  EXPECT_FALSE(flow.link_lost(kNow + 2s));  // sensor 1 answers
}

TEST_F(FlowControlTest, LinkIsLostWhenNobodyAnswersAndFoundWhenSomebodyDoes) {
  FlowControl flow = Make();
  SendTick(flow, 1, kNow);
  EXPECT_EQ(flow.Full(kNow + 2s), std::nullopt);
  EXPECT_TRUE(flow.link_lost(kNow + 2s));
  EXPECT_EQ(flow.counters().link_losses, 1U);
  SendTick(flow, 2, kNow + 2s);
  Answer(flow, 1, 2);
  EXPECT_EQ(flow.Full(kNow + 2s), std::nullopt);
  EXPECT_FALSE(flow.link_lost(kNow + 2s));
  EXPECT_EQ(flow.counters().link_losses, 1U);
}

TEST_F(FlowControlTest, SecondFiltersAnswersDoNotCount) {
  FlowControl flow = Make();
  SendTick(flow, 1, kNow);
  body::SegmentState beside;
  beside.slot = 1;
  beside.sensor_uid = SensorUid{1};
  beside.sequence = 1;
  EXPECT_FALSE(flow.OnState(beside));
  EXPECT_TRUE(flow.Outstanding(kNow).has_value());
}

TEST_F(FlowControlTest, PostureHoldsToo) {
  config_.wait_for = WaitFor::kPosture;
  FlowControl flow = Make();
  for (const std::uint32_t sequence : {1U, 2U}) {
    SendTick(flow, sequence, kNow);
    Answer(flow, 1, sequence);
    Answer(flow, 2, sequence);
  }
  ASSERT_TRUE(flow.Full(kNow).has_value());
  body::Skeleton skeleton;
  skeleton.body_id = BodyId{1};
  skeleton.measured_at = TickTime(2);  // stands for the tick before as well
  EXPECT_TRUE(flow.OnSkeleton(skeleton));
  EXPECT_EQ(flow.Full(kNow), std::nullopt);
  EXPECT_EQ(flow.Outstanding(kNow), std::nullopt);
  EXPECT_EQ(flow.counters().ticks_unanswered, 0U);
}

TEST_F(FlowControlTest, AtAGivenPaceNothingIsHeld) {
  config_.pace.as_fast = false;
  FlowControl flow = Make();
  for (std::uint32_t sequence = 1; sequence < 10; ++sequence) {
    SendTick(flow, sequence, kNow);
  }
  EXPECT_EQ(flow.Full(kNow), std::nullopt);
  EXPECT_EQ(flow.Outstanding(kNow), std::nullopt);
  EXPECT_EQ(flow.counters().samples_unanswered, 0U);
}

TEST_F(FlowControlTest, ProbesOpenTheWayAndWakeTheWorker) {
  config_.wait_for = WaitFor::kFusion;
  FlowControl flow = Make();
  flow.StartProbing(kNow);
  EXPECT_FALSE(Answer(flow, 1, 0));
  EXPECT_FALSE(flow.WayOpen());
  EXPECT_EQ(flow.Missing(), "fusion: 1 of 2 sensors silent");
  EXPECT_TRUE(Answer(flow, 2, 0));
  EXPECT_TRUE(flow.WayOpen());
  EXPECT_EQ(flow.counters().late_answers, 0U);
}

TEST_F(FlowControlTest, WithoutARosterOfOursOnlySensorsThatAnswerAreFollowed) {
  config_.publish_roster = false;
  FlowControl flow = Make();
  SendTick(flow, 1, kNow);
  EXPECT_EQ(flow.Outstanding(kNow), std::nullopt);
  Answer(flow, 1, 1);
  SendTick(flow, 2, kNow);
  SendTick(flow, 3, kNow);
  EXPECT_TRUE(flow.Full(kNow).has_value());
}

}  // namespace
}  // namespace limbcast::gateway
