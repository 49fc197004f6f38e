#include "tools/limbcast/evaluate/coil_report.hpp"

#include <gtest/gtest.h>

#include <vector>

namespace limbcast::tool {
namespace {

CoilResult SomeResult() {
  CoilResult result;
  result.experiment = "bench";
  result.figures[static_cast<std::size_t>(CoilMethod::kForward)] = {
      .count = 10, .position_m = 0.0123, .distance_m = 0.0045, .orientation_rad = 0.0174533};
  result.figures[static_cast<std::size_t>(CoilMethod::kLoose)] = {
      .count = 10, .position_m = 0.0234, .distance_m = 0.0056, .orientation_rad = 0.0349066};
  result.forward = {.tracked = 1.0, .losses = 0, .nees = 1.1};
  result.loose = {.tracked = 0.9, .losses = 2, .nees = 1.3};
  return result;
}

TEST(CoilReportTest, TheTableHasOurFiguresBesideThePublishedOnes) {
  const auto experiments = MakeCoilExperiments(1);
  const std::vector<CoilResult> results = {SomeResult()};
  const std::string text = CoilTable(experiments, results);
  EXPECT_NE(text.find("   12.3    4.5  1.00"), std::string::npos) << text;
  EXPECT_NE(text.find("   23.4    5.6  2.00"), std::string::npos) << text;
  EXPECT_NE(text.find(" 90%      2   1.3"), std::string::npos) << text;
  EXPECT_NE(text.find("7.6   5.9   5.2  3.0"), std::string::npos) << text;
}

TEST(CoilReportTest, JsonIsInMetresAndRadians) {
  const auto experiments = MakeCoilExperiments(1);
  const std::vector<CoilResult> results = {SomeResult()};
  const auto json = CoilJson(experiments, results, 7);
  EXPECT_EQ(json["seed"], 7);
  const auto& trial = json["trials"][0];
  EXPECT_DOUBLE_EQ(trial["forward"]["position_m"].get<double>(), 0.0123);
  EXPECT_DOUBLE_EQ(trial["tracked"].get<double>(), 1.0);
  EXPECT_DOUBLE_EQ(trial["loose"]["position_m"].get<double>(), 0.0234);
  EXPECT_DOUBLE_EQ(trial["loose"]["tracked"].get<double>(), 0.9);
  EXPECT_DOUBLE_EQ(trial["published"]["fused_m"].get<double>(), 5.2e-3);
}

}  // namespace
}  // namespace limbcast::tool
