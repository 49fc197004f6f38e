#include "tools/limbcast/top/top_table.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <chrono>

namespace limbcast::tool {
namespace {

using namespace std::chrono_literals;
using ::testing::HasSubstr;

constexpr Time kStart = TimeFromNanoseconds(1'700'000'000'000'000'000);

body::SegmentState State() {
  body::SegmentState state;
  state.body_id = BodyId{1};
  state.segment = body::Segment::kHead;
  state.started = true;
  state.verdict = SampleVerdict::kFused;
  state.magnetic_state = MagneticState::kDisturbed;
  state.lost_count = 4;
  state.filter = "tqt";
  return state;
}

TEST(TopTableTest, RateIsWhatCameSinceTheLastTable) {
  PipelineModel model;
  for (int i = 0; i < 30; ++i) {
    model.On(State(), kStart);
  }
  const TopCounts before = CountsOf(model, kStart);
  for (int i = 0; i < 50; ++i) {
    model.On(State(), kStart + 500ms);
  }
  const nlohmann::json segment = TopJson(model, before, kStart + 1s)["bodies"][0]["segments"][0];
  EXPECT_DOUBLE_EQ(segment["rate_hz"].get<double>(), 50.0);
  EXPECT_DOUBLE_EQ(segment["age_s"].get<double>(), 0.5);
  EXPECT_EQ(segment["magnetic_state"], "disturbed");
  EXPECT_EQ(segment["lost"], 4);
}

TEST(TopTableTest, TextHasALineForEachProcessAndSegment) {
  PipelineModel model;
  model.On(State(), kStart);
  ServiceHealth health;
  health.role = "fusion";
  health.pid = 4711;
  health.last_error = "no roster";
  model.On(health);
  roster::RosterEntry entry;
  entry.body_id = BodyId{1};
  entry.person = "Ada";
  model.On(entry);
  const std::string text = TopText(TopJson(model, CountsOf(model, kStart), kStart + 1s));
  EXPECT_THAT(text, HasSubstr("4711"));
  EXPECT_THAT(text, HasSubstr("no roster"));
  EXPECT_THAT(text, HasSubstr("BODY 1 Ada"));
  EXPECT_THAT(text, HasSubstr("head"));
  EXPECT_THAT(text, HasSubstr("disturbed"));
}

TEST(TopTableTest, AnEmptyNetworkIsSaidSo) {
  EXPECT_THAT(TopText(TopJson({}, {}, kStart)), HasSubstr("nobody reports here"));
}

}  // namespace
}  // namespace limbcast::tool
