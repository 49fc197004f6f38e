#include "tools/limbcast/monitor/pipeline_model.hpp"

#include <gtest/gtest.h>

#include <chrono>

namespace limbcast::tool {
namespace {

using namespace std::chrono_literals;

constexpr Time kStart = TimeFromNanoseconds(1'700'000'000'000'000'000);

body::Skeleton Skeleton(std::uint32_t sequence, body::SegmentStatus status) {
  body::Skeleton skeleton;
  skeleton.body_id = BodyId{1};
  skeleton.sequence = sequence;
  skeleton.complete = status == body::SegmentStatus::kTracked;
  skeleton.measured_at = kStart + sequence * 10ms;
  skeleton.segments.push_back({.segment = body::Segment::kHead, .status = status});
  return skeleton;
}

TEST(PipelineModelTest, AnswersToProbesAreNotSkeletons) {
  PipelineModel model;
  model.On(Skeleton(1, body::SegmentStatus::kMissing), kStart);
  EXPECT_EQ(model.skeletons(), 0U);
  EXPECT_EQ(model.probe_skeletons, 1U);
  model.On(Skeleton(2, body::SegmentStatus::kTracked), kStart);
  model.On(Skeleton(3, body::SegmentStatus::kMissing), kStart);  // later it is a real one
  EXPECT_EQ(model.skeletons(), 2U);
  EXPECT_EQ(model.bodies.at(BodyId{1}).incomplete, 1U);
}

TEST(PipelineModelTest, RateIsIntervalsOverTheSpan) {
  PipelineModel model;
  for (std::uint32_t i = 1; i <= 101; ++i) {
    model.On(Skeleton(i, body::SegmentStatus::kTracked), kStart + i * 10ms);
  }
  EXPECT_NEAR(model.skeleton_rate_hz(), 100.0, 1e-9);
  EXPECT_EQ(model.tracked_segments(), 1U);
}

TEST(PipelineModelTest, GapsInTheNumbersOfSkeletonsAreCounted) {
  PipelineModel model;
  model.On(Skeleton(5, body::SegmentStatus::kTracked), kStart);
  model.On(Skeleton(9, body::SegmentStatus::kTracked), kStart);
  EXPECT_EQ(model.bodies.at(BodyId{1}).lost, 3U);
  EXPECT_EQ(model.bodies.at(BodyId{1}).longest_step, 40ms);
  model.On(Skeleton(1, body::SegmentStatus::kTracked), kStart);  // posture was restarted
  EXPECT_EQ(model.bodies.at(BodyId{1}).lost, 3U);
}

TEST(PipelineModelTest, FromAMarkOnOnlyWhatComesLaterIsMeasured) {
  PipelineModel model;
  model.On(Skeleton(1, body::SegmentStatus::kTracked), kStart + 1s);
  model.Mark();
  EXPECT_EQ(model.latencies.total().count(), 0U);
  model.On(Skeleton(4, body::SegmentStatus::kTracked), kStart + 1s);
  EXPECT_EQ(model.latencies.total().count(), 1U);
  EXPECT_EQ(model.skeletons_since_mark(), 1U);
  EXPECT_EQ(model.skeletons(), 2U);
  EXPECT_EQ(model.bodies.at(BodyId{1}).lost, 2U) << "losses count from the begin";
}

TEST(PipelineModelTest, TheFilterBesideIsNotTheOneInUse) {
  PipelineModel model;
  body::SegmentState state;
  state.slot = 1;
  model.On(state, kStart);
  EXPECT_TRUE(model.bodies.empty());
}

ServiceHealth Report(std::uint64_t uid, std::string role, std::vector<NamedValue> values) {
  ServiceHealth health;
  health.process_uid = uid;
  health.role = std::move(role);
  health.values = std::move(values);
  return health;
}

std::uint64_t Sum(const std::map<std::string, std::uint64_t>& counts) {
  std::uint64_t sum = 0;
  for (const auto& [name, count] : counts) {
    sum += count;
  }
  return sum;
}

TEST(AccountTest, EverySampleIsFilteredRefusedOrLost) {
  HealthLedger health;
  health.Add(Report(1, "gateway", {{"samples.published", 100}}));
  health.Add(Report(2, "fusion",
                    {{"verdict.fused", 80},
                     {"verdict.predicted_only", 5},
                     {"verdict.starting", 4},
                     {"verdict.duplicate", 3},
                     {"verdict.not_finite", 2},
                     {"verdict.time", 0},
                     {"samples.lost", 6}}));
  const Accounting account = Account(health);
  EXPECT_EQ(account.published, 100U);
  EXPECT_EQ(account.filtered, 89U);
  EXPECT_EQ(account.refused,
            (std::map<std::string, std::uint64_t>{{"duplicate", 3}, {"not_finite", 2}}));
  EXPECT_EQ(account.lost, 6U);
  EXPECT_EQ(account.lost_seen, 6U);
}

TEST(AccountTest, StillBalancesWhenAProcessDiedBeforeItsLastReport) {
  HealthLedger health;
  health.Add(Report(1, "gateway", {{"samples.published", 100}}));  // killed here
  health.Add(Report(2, "gateway", {{"samples.published", 50}}));
  health.Add(Report(3, "fusion", {{"verdict.fused", 170}, {"verdict.duplicate", 5}}));
  const Accounting account = Account(health);
  EXPECT_EQ(account.published, account.filtered + Sum(account.refused) + account.lost);
  EXPECT_EQ(account.published, 175U);
  EXPECT_EQ(account.lost, 0U);
}

}  // namespace
}  // namespace limbcast::tool
