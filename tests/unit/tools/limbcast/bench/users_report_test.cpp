#include "tools/limbcast/bench/users_report.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tools/limbcast/bench/users_bench.hpp"
#include "tools/limbcast/demo/demo_summary.hpp"

namespace limbcast::tool {
namespace {

using ::testing::HasSubstr;

// A run in which everything held: cost and memory proportional to the people.
UsersRun Held(int people) {
  UsersRun run;
  run.people = people;
  run.clean_exit = true;
  run.samples = 1500U * static_cast<std::uint64_t>(people);
  run.skeletons = 100U * static_cast<std::uint64_t>(people);
  run.rate_hz = 100.0;
  run.p50_ms = 1.0;
  run.p99_ms = 5.0;
  run.cores = {{"gateway", 0.001 * people},
               {"fusion", 0.01 * people + 0.02},
               {"posture", 0.005 * people},
               {"client", 0.002 * people}};
  run.rss_mib = {{"fusion", 20.0 + 0.1 * people}, {"posture", 15.0 + 0.05 * people}};
  run.host_cores = 0.018 * people + 0.52;
  return run;
}

TEST(UsersReportTest, SaysWhatDidNotHoldWithValueAndLimit) {
  const UsersLimits limits{.p99_ms = 20.0};
  EXPECT_EQ(Complaint(Held(3), limits), "");
  UsersRun run = Held(3);
  run.samples_lost = 2;
  EXPECT_THAT(Complaint(run, limits), HasSubstr("2 samples"));
  run = Held(3);
  run.skeletons_lost = 1;
  EXPECT_THAT(Complaint(run, limits), HasSubstr("1 skeletons"));
  run = Held(3);
  run.p99_ms = 20.0;
  EXPECT_THAT(Complaint(run, limits), HasSubstr("p99 20.0 ms, must be below 20.0"));
  run = Held(3);
  run.rate_hz = 90.0;
  EXPECT_THAT(Complaint(run, limits), HasSubstr("90.0 skeletons a second"));
  run = Held(3);
  run.clean_exit = false;
  EXPECT_NE(Complaint(run, limits), "");
  run = Held(3);
  run.refused = "limbcast-fusion ended with status 2";
  EXPECT_EQ(Complaint(run, limits), run.refused);
}

TEST(UsersReportTest, WhatOthersDidIsTheHostWithoutUs) {
  EXPECT_NEAR(Held(10).other_cores(), 0.5, 1e-9);
}

TEST(UsersReportTest, CostOfAPersonIsTheSlopeThroughTheRunsThatHeld) {
  std::vector<UsersRun> runs = {Held(1), Held(2), Held(4), Held(8)};
  UsersRun too_many = Held(16);
  too_many.samples_lost = 7;
  too_many.cores["fusion"] = 2.0;  // not on the line, and not to count
  runs.push_back(too_many);
  const nlohmann::json report = ReportJson("cyclone", {}, runs);
  EXPECT_EQ(report["largest"], 8);
  EXPECT_EQ(report["runs"].size(), 5U);
  EXPECT_EQ(report["runs"][4]["held"], false);
  EXPECT_NEAR(report["cpu"]["fusion"]["each_person_core_percent"].get<double>(), 1.0, 1e-9);
  EXPECT_NEAR(report["cpu"]["fusion"]["without_people_core_percent"].get<double>(), 2.0, 1e-9);
  EXPECT_NEAR(report["memory_fusion_posture"]["each_person_kib"].get<double>(), 0.15 * 1024, 1e-6);
  EXPECT_NEAR(report["memory_fusion_posture"]["without_people_kib"].get<double>(), 35 * 1024, 1e-6);
  const std::string text = ReportText(report);
  EXPECT_THAT(text, HasSubstr("8 people x 15 sensors x 100 Hz on cyclone"));
  EXPECT_THAT(text, HasSubstr("153.60 KiB for each person"));
  EXPECT_THAT(text, HasSubstr("; linear"));
}

TEST(UsersReportTest, CostThatGrowsFasterThanThePeopleIsCalledSo) {
  std::vector<UsersRun> runs = {Held(1), Held(8), Held(16)};
  for (UsersRun& run : runs) {
    run.cores["posture"] = 0.001 * run.people * run.people;
  }
  EXPECT_THAT(ReportText(ReportJson("fast", {}, runs)), HasSubstr("NOT linear"));
}

TEST(UsersReportTest, OneRunHasNoSlope) {
  const nlohmann::json report = ReportJson("fast", {}, {Held(3)});
  EXPECT_TRUE(report["memory_fusion_posture"].is_null());
  EXPECT_THAT(ReportText(report), HasSubstr("3 people"));
}

TEST(UsersReportTest, ReadsTheSummaryOfADemo) {
  DemoOutcome outcome;
  outcome.duration_s = 2.0;
  outcome.clean_exit = true;
  outcome.client_cpu_seconds = 0.5;
  outcome.host_busy_seconds = 3.0;
  outcome.host_stolen_seconds = 0.2;
  PipelineModel model;
  ServiceHealth fusion;
  fusion.process_uid = 1;
  fusion.role = "fusion";
  fusion.rss_mib = 24.0;
  fusion.values = {{"verdict.fused", 80}, {"verdict.overload", 3}};
  model.On(fusion);
  ServiceHealth gateway;
  gateway.process_uid = 2;
  gateway.role = "gateway";
  gateway.values = {{"samples.published", 90}};
  model.On(gateway);
  const UsersRun run = RunOf(4, SummaryJson({}, model, outcome));
  EXPECT_EQ(run.people, 4);
  EXPECT_EQ(run.samples, 90U);
  EXPECT_EQ(run.samples_lost, 10U) << "seven never seen, three refused";
  EXPECT_TRUE(run.clean_exit);
  EXPECT_NEAR(run.cores.at("client"), 0.25, 1e-9);
  EXPECT_FALSE(run.cores.contains("host"));
  EXPECT_NEAR(run.host_cores, 1.5, 1e-9);
  EXPECT_NEAR(run.other_cores(), 1.25, 1e-9);
  EXPECT_NEAR(run.stolen_cores, 0.1, 1e-9);
  EXPECT_NEAR(run.rss_mib.at("fusion"), 24.0, 1e-6);
}

TEST(UsersBenchTest, APersonIsFifteenSensorsInFramesAndTheUsersSettingsComeLast) {
  UsersBenchOptions options;
  options.seconds = 7.0;
  options.demo.gateway_settings = {"simulator.n_pose_s=3"};
  const DemoOptions demo = DemoFor(options, 12);
  EXPECT_EQ(demo.gateway_settings.back(), "simulator.n_pose_s=3");
  EXPECT_THAT(demo.gateway_settings, ::testing::Contains("simulator.persons=12"));
  EXPECT_THAT(demo.gateway_settings, ::testing::Contains("simulator.sensors=reduced15"));
  EXPECT_THAT(demo.gateway_settings, ::testing::Contains("gateway.marg_frame=true"));
  EXPECT_DOUBLE_EQ(demo.seconds - demo.settle_seconds, 7.0);
  EXPECT_TRUE(demo.quiet);
}

}  // namespace
}  // namespace limbcast::tool
