// The whole pipeline in real processes on loopback, as a newcomer runs it.
#include <gtest/gtest.h>

#include <chrono>
#include <string>

#include "tests/system/program.hpp"

namespace limbcast {
namespace {

using namespace std::chrono_literals;
using namespace test_support;

class DemoTest : public ::testing::TestWithParam<const char*> {};

TEST_P(DemoTest, SimulatedPersonComesThroughWhole) {
  constexpr double kSeconds = 9.0;
  const DemoRun run = RunDemo({"--dds", GetParam(), "--seconds", "9"}, 60s);
  ASSERT_EQ(run.outcome.status, 0) << Describe(run.outcome);
  ASSERT_TRUE(run.summary.is_object()) << Describe(run.outcome);
  const nlohmann::json& summary = run.summary;
  SCOPED_TRACE(summary.dump(2));

  EXPECT_EQ(summary["dds"], GetParam());
  EXPECT_EQ(summary["clean_exit"], true);
  EXPECT_EQ(summary["bodies"], 1);
  EXPECT_GE(summary["segments"].get<int>(), 15);

  const Balance balance = BalanceOf(summary);
  EXPECT_EQ(balance.published, balance.filtered + balance.refused + balance.lost);
  EXPECT_EQ(balance.lost, 0U);
  EXPECT_EQ(summary["samples_lost_seen_by_fusion"], 0);
  EXPECT_EQ(balance.refused, 0U);
  // 100 Hz for each segment; the gateway runs a little longer than the seconds that are counted.
  const double expected = 100.0 * kSeconds * summary["segments"].get<double>();
  EXPECT_GE(static_cast<double>(balance.published), 0.99 * expected);
  EXPECT_LE(static_cast<double>(balance.published), 1.15 * expected);

  EXPECT_NEAR(summary["skeleton_rate_hz"].get<double>(), 100.0, 1.0);
  EXPECT_EQ(summary["skeletons_lost"], 0);
  ASSERT_TRUE(summary["orientation_error_deg"].is_object());
  EXPECT_LE(summary["orientation_error_deg"]["rms"].get<double>(), 3.0);
  EXPECT_GE(summary["orientation_error_deg"]["count"].get<double>(), 300.0 * 15);
  for (const char* process : {"gateway", "fusion", "posture", "client"}) {
    EXPECT_GT(summary["cpu_us_per_body_frame"][process].get<double>(), 0.0) << process;
    EXPECT_GT(summary["rss_mib"][process].get<double>(), 0.0) << process;
  }
  EXPECT_GT(summary["latency_us"]["p50"].get<double>(), 0.0);
  EXPECT_EQ(run.processes_left, 0U);
  EXPECT_TRUE(run.shared_memory_left.empty()) << *run.shared_memory_left.begin();
}

INSTANTIATE_TEST_SUITE_P(Dds, DemoTest, ::testing::Values("cyclone", "fast", "mixed"),
                         [](const auto& test) { return std::string(test.param); });

// Coils and a marker: simulator, gateway, fusion, posture, and back to the truth.
TEST_P(DemoTest, CoilsAndMarkersPlaceWristsShinsAndThePelvis) {
  const DemoRun run =
      RunDemo({"--dds", GetParam(), "--seconds", "14", "--coils", "--markers"}, 60s);
  ASSERT_EQ(run.outcome.status, 0) << Describe(run.outcome);
  ASSERT_TRUE(run.summary.is_object()) << Describe(run.outcome);
  SCOPED_TRACE(run.summary.dump(2));
  EXPECT_EQ(BalanceOf(run.summary).lost, 0U);
  const nlohmann::json& sensors = run.summary["position_error_mm"]["sensors"];
  for (const char* wrist : {"1.right_fore_arm", "1.left_fore_arm"}) {
    ASSERT_TRUE(sensors.contains(wrist)) << wrist;
    EXPECT_GT(sensors[wrist]["count"].get<int>(), 300) << wrist;
    EXPECT_LT(sensors[wrist]["rms"].get<double>(), 30.0) << wrist;
  }
  for (const char* shin : {"1.right_lower_leg", "1.left_lower_leg"}) {
    ASSERT_TRUE(sensors.contains(shin)) << shin;
    EXPECT_GT(sensors[shin]["count"].get<int>(), 300) << shin;
    EXPECT_LT(sensors[shin]["rms"].get<double>(), 50.0) << shin;
  }
  ASSERT_TRUE(sensors.contains("1.pelvis"));
  EXPECT_LT(sensors["1.pelvis"]["rms"].get<double>(), 20.0);
  const nlohmann::json& lagged = run.summary["position_error_mm"]["sensors_lagged"];
  for (const auto& [name, live] : sensors.items()) {
    ASSERT_TRUE(lagged.contains(name)) << name;
    EXPECT_GT(lagged[name]["count"].get<int>(), 200) << name;
    EXPECT_LT(lagged[name]["rms"].get<double>(), live["rms"].get<double>()) << name;
  }
  const nlohmann::json& skeleton = run.summary["position_error_mm"]["skeleton"];
  for (const char* joint :
       {"1.pelvis", "1.right_hand", "1.left_hand", "1.right_foot", "1.left_foot"}) {
    ASSERT_TRUE(skeleton.contains(joint)) << joint;
    EXPECT_LT(skeleton[joint]["rms"].get<double>(), 80.0) << joint;
  }
  EXPECT_NE(run.outcome.output.find("mm RMS"), std::string::npos);
}

TEST(DemoFaultsTest, BadSamplesAreRefusedByNameAndNothingElseSuffers) {
  const DemoRun run =
      RunDemo({"--seconds", "6", "--gateway-set", "simulator.faults.not_finite_rate=0.01",
               "--gateway-set", "simulator.faults.duplicate_rate=0.01", "--gateway-set",
               "simulator.faults.out_of_order_rate=0.01"},
              60s);
  ASSERT_EQ(run.outcome.status, 0) << Describe(run.outcome);
  SCOPED_TRACE(run.summary.dump(2));
  const Balance balance = BalanceOf(run.summary);
  EXPECT_EQ(balance.published, balance.filtered + balance.refused + balance.lost);
  EXPECT_EQ(balance.lost, 0U);
  // A sample of which one channel is not finite is used without that channel, so it is no refusal.
  for (const char* verdict : {"duplicate", "out_of_order"}) {
    EXPECT_GT(run.summary["samples_refused"].value(verdict, 0), 20) << verdict;
  }
  EXPECT_LT(static_cast<double>(balance.refused), 0.04 * static_cast<double>(balance.published));
  EXPECT_NEAR(run.summary["skeleton_rate_hz"].get<double>(), 100.0, 2.0);
  ASSERT_TRUE(run.summary["orientation_error_deg"].is_object());
  EXPECT_LE(run.summary["orientation_error_deg"]["rms"].get<double>(), 3.0);
}

TEST(DemoFaultsTest, SaturatedSamplesAndGapsAreAccountedFor) {
  const DemoRun run =
      RunDemo({"--seconds", "4", "--gateway-set", "simulator.faults.saturated_rate=0.01",
               "--gateway-set", "simulator.faults.gap_rate=0.002"},
              60s);
  ASSERT_EQ(run.outcome.status, 0) << Describe(run.outcome);
  SCOPED_TRACE(run.summary.dump(2));
  const Balance balance = BalanceOf(run.summary);
  EXPECT_EQ(balance.published, balance.filtered + balance.refused + balance.lost);
  EXPECT_EQ(balance.lost, 0U) << "what a sensor leaves out was never published";
  EXPECT_GT(run.summary["skeletons_incomplete"].get<int>(), 20) << "the gaps are visible";
  EXPECT_NEAR(run.summary["skeleton_rate_hz"].get<double>(), 100.0, 2.0);
}

TEST(DemoRefusalTest, ADemoThatCannotBeginSaysWhyOnOneLine) {
  const DemoRun run = RunDemo({"--seconds", "2", "--gateway-set", "simulator.rate_hz=0"}, 30s);
  EXPECT_EQ(run.outcome.status, 2) << Describe(run.outcome);
  EXPECT_NE(run.outcome.errors.find("simulator.rate_hz"), std::string::npos) << run.outcome.errors;
  EXPECT_EQ(std::count(run.outcome.errors.begin(), run.outcome.errors.end(), '\n'), 1)
      << run.outcome.errors;
  EXPECT_EQ(run.processes_left, 0U);
}

}  // namespace
}  // namespace limbcast
