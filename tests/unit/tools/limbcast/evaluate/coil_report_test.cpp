#include "tools/limbcast/evaluate/coil_report.hpp"

#include <gtest/gtest.h>

#include <vector>

namespace limbcast::tool {
namespace {

CoilResult SomeResult() {
  CoilResult result;
  result.experiment = "bench";
  result.figures[1] = {
      .count = 10, .position_m = 0.0123, .distance_m = 0.0045, .orientation_rad = 0.0174533};
  result.tracked = 1.0;
  return result;
}

TEST(CoilReportTest, TheTableHasOurFiguresBesideThePublishedOnes) {
  const auto experiments = MakeCoilExperiments(1);
  const std::vector<CoilResult> results = {SomeResult()};
  const std::string text = CoilTable(experiments, results);
  EXPECT_NE(text.find("   12.3    4.5  1.00"), std::string::npos) << text;
  EXPECT_NE(text.find("7.6   5.9   5.2  3.0"), std::string::npos) << text;
}

TEST(CoilReportTest, JsonIsInMetresAndRadians) {
  const auto experiments = MakeCoilExperiments(1);
  const std::vector<CoilResult> results = {SomeResult()};
  const auto json = CoilJson(experiments, results, 7);
  EXPECT_EQ(json["seed"], 7);
  const auto& trial = json["trials"][0];
  EXPECT_DOUBLE_EQ(trial["forward"]["position_m"].get<double>(), 0.0123);
  EXPECT_DOUBLE_EQ(trial["published"]["fused_m"].get<double>(), 5.2e-3);
}

}  // namespace
}  // namespace limbcast::tool
