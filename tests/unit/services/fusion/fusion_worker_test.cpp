#include "services/fusion/fusion_worker.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/unit/services/fusion/fusion_fixture.hpp"

namespace limbcast::fusion {
namespace {

using ::testing::ElementsAre;
using ::testing::Pair;
using ::testing::UnorderedElementsAre;

/// Writes down what a worker publishes, and when it flushes.
class WriterSpy final : public bus::Writer<body::SegmentState> {
 public:
  Status Write(const body::SegmentState& value) override {
    if (fail) {
      return Error{ErrorCode::kTimeout, "no"};
    }
    written.push_back(value);
    return Ok();
  }
  Status Dispose(const body::SegmentState& key) override {
    disposed.emplace_back(key.segment, key.slot);
    return Ok();
  }
  void Flush() override { flushed_after.push_back(written.size()); }
  bus::EndpointCounters counters() const override { return {}; }

  bool fail = false;
  std::vector<body::SegmentState> written;
  std::vector<std::pair<body::Segment, std::uint8_t>> disposed;
  std::vector<std::size_t> flushed_after;
};

class FusionWorkerTest : public ::testing::Test {
 protected:
  static std::shared_ptr<const BodyPlan> Plan(
      std::uint32_t body_id, std::vector<std::pair<std::uint64_t, body::Segment>> sensors,
      std::string beside = "") {
    BodyPlan plan{.body_id = BodyId{body_id}, .tracks = {}};
    for (const auto& [uid, segment] : sensors) {
      plan.tracks.push_back({.sensor_uid = SensorUid{uid},
                             .segment = segment,
                             .filters = {"tqt", beside},
                             .overloads = 0});
    }
    return std::make_shared<const BodyPlan>(std::move(plan));
  }
  bool Offer(std::uint64_t uid, std::uint32_t sequence) {
    return worker.Offer(world.Sample(uid, sequence), {.received_at = world.clock.Now()});
  }
  FusionCounters Counters() const {
    FusionCounters sum;
    worker.counters().AddTo(sum);
    return sum;
  }

  FusionWorld world;
  const FilterFactory factory = CountingFilters();
  FusionConfig config = [] {
    FusionConfig small;
    small.queue_capacity = 128;
    return small;
  }();
  StateWriters writers{.single = std::make_unique<WriterSpy>(), .frames = nullptr};
  WriterSpy& writer = static_cast<WriterSpy&>(*writers.single);
  FusionLatencies latencies;
  SavedFilters saved;
  FusionWorker worker{config, factory, world.clock, writers, latencies, saved};
};

TEST_F(FusionWorkerTest, DrainAnswersEverySampleInOrderAndFlushesOnceAtTheEnd) {
  ASSERT_TRUE(worker.Offer(Plan(1, {{10, body::Segment::kHead}})));
  for (std::uint32_t i = 1; i <= 20; ++i) {
    ASSERT_TRUE(Offer(10, i));
  }
  worker.Drain();
  ASSERT_EQ(writer.written.size(), 20U);
  for (std::uint32_t i = 1; i <= 20; ++i) {
    EXPECT_EQ(writer.written[i - 1].sequence, i);
    EXPECT_EQ(writer.written[i - 1].stages.fusion_published_at, world.clock.Now());
  }
  EXPECT_THAT(writer.flushed_after, ElementsAre(20U));
  worker.Drain();
  EXPECT_EQ(writer.flushed_after.size(), 1U) << "nothing written, nothing to flush";
}

TEST_F(FusionWorkerTest, ALongQueueIsFlushedOnTheWay) {
  ASSERT_TRUE(worker.Offer(Plan(1, {{10, body::Segment::kHead}})));
  for (std::uint32_t i = 1; i <= 90; ++i) {
    ASSERT_TRUE(Offer(10, i));
  }
  worker.Drain();
  EXPECT_EQ(writer.flushed_after.size(), 3U);
  EXPECT_EQ(writer.flushed_after.back(), 90U);
  EXPECT_EQ(Counters().queue_high_water, 91U);
}

TEST_F(FusionWorkerTest, AFullQueueRefusesSamplesButStillTakesAPlan) {
  std::uint32_t accepted = 0;
  while (Offer(10, accepted + 1)) {
    ++accepted;
  }
  EXPECT_LT(accepted, 128U);
  EXPECT_TRUE(worker.Offer(Plan(1, {{10, body::Segment::kHead}})));
  worker.Drain();
  EXPECT_EQ(Counters().verdicts[SampleVerdict::kRejectedUnassigned], accepted)
      << "they came before their plan";
}

TEST_F(FusionWorkerTest, SegmentsThatLoseTheirSensorAreDisposed) {
  ASSERT_TRUE(
      worker.Offer(Plan(1, {{10, body::Segment::kHead}, {11, body::Segment::kPelvis}}, "slow")));
  worker.Drain();
  ASSERT_TRUE(worker.Offer(Plan(1, {{12, body::Segment::kHead}})));  // another sensor, no beside
  worker.Drain();
  EXPECT_THAT(writer.disposed,
              UnorderedElementsAre(Pair(body::Segment::kHead, 1), Pair(body::Segment::kPelvis, 0),
                                   Pair(body::Segment::kPelvis, 1)));
  writer.disposed.clear();
  ASSERT_TRUE(worker.Offer(Plan(1, {})));
  worker.Drain();
  EXPECT_THAT(writer.disposed, ElementsAre(Pair(body::Segment::kHead, 0)));
}

TEST_F(FusionWorkerTest, ASensorThatMovesToAnotherBodyOfTheSameWorkerStartsAnew) {
  ASSERT_TRUE(worker.Offer(Plan(1, {{10, body::Segment::kHead}})));
  ASSERT_TRUE(Offer(10, 1));
  ASSERT_TRUE(worker.Offer(Plan(1, {})));
  ASSERT_TRUE(worker.Offer(Plan(2, {{10, body::Segment::kNeck}})));
  ASSERT_TRUE(Offer(10, 2));
  worker.Drain();
  ASSERT_EQ(writer.written.size(), 2U);
  EXPECT_EQ(writer.written[1].body_id, BodyId{2});
  EXPECT_EQ(writer.written[1].segment, body::Segment::kNeck);
  EXPECT_EQ(writer.written[1].verdicts.used(), 1U);
}

TEST_F(FusionWorkerTest, ARefusedWriteIsCounted) {
  ASSERT_TRUE(worker.Offer(Plan(1, {{10, body::Segment::kHead}})));
  ASSERT_TRUE(Offer(10, 1));
  writer.fail = true;
  worker.Drain();
  EXPECT_EQ(Counters().publish_errors, 1U);
  EXPECT_EQ(Counters().published, 0U);
  EXPECT_EQ(Counters().verdicts.used(), 1U);
}

TEST_F(FusionWorkerTest, LatenciesAreRecordedByStage) {
  ASSERT_TRUE(worker.Offer(Plan(1, {{10, body::Segment::kHead}})));
  const Time received_at = world.clock.Now();
  sensing::MargSample sample = world.Sample(10, 1);
  sample.published_at = received_at - std::chrono::microseconds(100);
  ASSERT_TRUE(worker.Offer(sample, {.received_at = received_at}));
  world.clock.Advance(std::chrono::microseconds(50));
  worker.Drain();
  EXPECT_NEAR(latencies.gateway_to_fusion.Take("").max_us, 100.0F, 1e-3F);
  EXPECT_NEAR(latencies.queue.Take("").max_us, 50.0F, 1e-3F);
  EXPECT_NEAR(latencies.fusion.Take("").max_us, 50.0F, 1e-3F);
  EXPECT_EQ(latencies.step.Take("").count, 1U);
}

}  // namespace
}  // namespace limbcast::fusion
