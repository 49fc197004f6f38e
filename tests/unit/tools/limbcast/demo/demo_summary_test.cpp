#include "tools/limbcast/demo/demo_summary.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <chrono>

namespace limbcast::tool {
namespace {

using namespace std::chrono_literals;
using ::testing::HasSubstr;

constexpr Time kStart = TimeFromNanoseconds(1'700'000'000'000'000'000);

ServiceHealth Report(std::uint64_t uid, std::string role, double cpu_seconds, Duration at) {
  ServiceHealth health;
  health.process_uid = uid;
  health.role = std::move(role);
  health.cpu_seconds = cpu_seconds;
  health.rss_mib = 12.5;
  health.reported_at = kStart + at;
  return health;
}

// Two seconds of one body at 100 Hz.
class DemoSummaryTest : public ::testing::Test {
 protected:
  DemoSummaryTest() {
    outcome_.duration_s = 2.0;
    for (std::uint32_t i = 1; i <= 200; ++i) {
      body::Skeleton skeleton;
      skeleton.body_id = BodyId{1};
      skeleton.sequence = i;
      skeleton.complete = true;
      skeleton.measured_at = kStart + i * 10ms;
      skeleton.segments.push_back(
          {.segment = body::Segment::kHead, .status = body::SegmentStatus::kTracked});
      model_.On(skeleton, skeleton.measured_at + 1ms);
    }
    ServiceHealth gateway = Report(1, "gateway", 0.0, 0s);
    gateway.values = {{"samples.published", 200}};
    model_.On(gateway);
    ServiceHealth fusion = Report(2, "fusion", 1.0, 0s);
    model_.On(fusion);
    fusion = Report(2, "fusion", 1.04, 2s);
    fusion.values = {{"verdict.fused", 197}, {"verdict.time", 1}, {"samples.lost", 2}};
    model_.On(fusion);
  }

  PipelineModel model_;
  DemoOutcome outcome_;
};

TEST_F(DemoSummaryTest, HasEveryKeyThatScriptsRelyOn) {
  const nlohmann::json summary = SummaryJson({}, model_, outcome_);
  for (const char* key :
       {"dds", "bodies", "segments", "samples_published", "samples_filtered", "samples_refused",
        "samples_lost", "skeletons", "skeleton_rate_hz", "latency_us", "orientation_error_deg",
        "cpu_us_per_body_frame", "rss_mib", "clean_exit"}) {
    EXPECT_TRUE(summary.contains(key)) << key;
  }
  for (const char* key : {"p50", "p99", "p999", "stages"}) {
    EXPECT_TRUE(summary["latency_us"].contains(key)) << key;
  }
  EXPECT_EQ(summary["samples_refused"], nlohmann::json({{"time", 1}}));
  EXPECT_EQ(summary["samples_lost"], 2);
  EXPECT_TRUE(summary["orientation_error_deg"].is_null());
}

TEST_F(DemoSummaryTest, CpuIsForOneBodyAndFrame) {
  const nlohmann::json summary = SummaryJson({}, model_, outcome_);
  // 40 ms in 2 s, 100 frames a second: 200 µs for each.
  EXPECT_NEAR(summary["cpu_us_per_body_frame"]["fusion"].get<double>(), 200.0, 1e-6);
  EXPECT_EQ(summary["rss_mib"]["fusion"], 12.5);
}

TEST_F(DemoSummaryTest, CpuOfARunTooShortForTwoReportsIsThatOfTheWholeLife) {
  outcome_.child_cpu_seconds = {{"gateway", 0.1}};
  const nlohmann::json summary = SummaryJson({}, model_, outcome_);
  EXPECT_NEAR(summary["cpu_us_per_body_frame"]["gateway"].get<double>(), 500.0, 1e-6);
}

TEST_F(DemoSummaryTest, TextSaysTheSame) {
  outcome_.restarts = {{"fusion", 1}};
  const std::string text = SummaryText(SummaryJson({}, model_, outcome_));
  EXPECT_THAT(text, HasSubstr("samples refused      1 time"));
  EXPECT_THAT(text, HasSubstr("samples lost         2"));
  EXPECT_THAT(text, HasSubstr("no truth to compare with"));
  EXPECT_THAT(text, HasSubstr("started again        fusion, 1 times"));
  EXPECT_THAT(text, HasSubstr("clean exit           NO"));
}

TEST_F(DemoSummaryTest, ProgressIsOneLine) {
  const std::string line = ProgressLine(model_, 2.0);
  EXPECT_EQ(line.find('\n'), std::string::npos);
  EXPECT_THAT(line, HasSubstr("200 skeletons, 100.0/s"));
}

TEST_F(DemoSummaryTest, PositionsAreSummedUpWhereTheyWereAskedFor) {
  EXPECT_TRUE(SummaryJson({}, model_, outcome_)["position_error_mm"].is_null());
  model_.judge_positions = true;
  model_.positions.CountFrom(kStart);
  for (int i = 0; i < 200; ++i) {
    body::SegmentTruth truth;
    truth.body_id = BodyId{1};
    truth.measured_at = kStart + i * 10ms;
    truth.segment_valid = true;
    model_.On(truth);
    body::SegmentState state;
    state.body_id = BodyId{1};
    state.measured_at = truth.measured_at;
    state.verdict = SampleVerdict::kFused;
    state.started = state.has_position = true;
    state.p_earth_sensor_m.y() = 0.004F;
    model_.On(state, state.measured_at);
  }
  DemoOptions options;
  options.markers = true;
  const nlohmann::json summary = SummaryJson(options, model_, outcome_);
  const nlohmann::json& pelvis = summary["position_error_mm"]["sensors"]["1.pelvis"];
  EXPECT_NEAR(pelvis["rms"].get<double>(), 4.0, 1e-3);
  EXPECT_GT(pelvis["count"].get<int>(), 30);
  EXPECT_THAT(SummaryText(summary), HasSubstr("4.0 mm RMS"));
}

}  // namespace
}  // namespace limbcast::tool
