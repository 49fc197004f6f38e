#include "tools/limbcast/evaluate/coil_adaptive.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

namespace limbcast::tool {
namespace {

using ::testing::HasSubstr;

TEST(CoilAdaptiveTest, PlannedPulsesAreFewerAndBetterThanATrainAsSeldom) {
  double planned_m = 0.0;
  double seldom_m = 0.0;
  for (const std::uint64_t seed : {5U, 6U, 7U}) {
    const CoilAdaptiveResult result =
        EvaluateAdaptive(MakeRestingExperiment(), CoilNoise::kThesis, seed);
    EXPECT_GT(result.planned.tracked, 0.95);
    EXPECT_LT(result.planned.duty, 0.36) << "the cap of the plan";
    EXPECT_NEAR(result.seldom.duty, result.planned.duty, 0.02);
    EXPECT_LT(result.planned.duty, result.usual.duty);
    planned_m += result.planned.position_m / 3.0;
    seldom_m += result.seldom.position_m / 3.0;
  }
  EXPECT_LT(planned_m, 0.95 * seldom_m);
}

TEST(CoilAdaptiveTest, TheTableAndTheFileHaveAllThreeWays) {
  CoilAdaptiveResult result;
  result.experiment = "rest and reach";
  result.usual = {.position_m = 0.004, .orientation_rad = 0.01, .duty = 0.3, .tracked = 1.0};
  result.planned = {.position_m = 0.005, .orientation_rad = 0.01, .duty = 0.1, .tracked = 1.0};
  result.seldom = {.position_m = 0.009, .orientation_rad = 0.01, .duty = 0.1, .tracked = 1.0};
  const std::string table = AdaptiveTable({&result, 1});
  EXPECT_THAT(table, HasSubstr("rest and reach"));
  EXPECT_THAT(table, HasSubstr("    4.0   0.57  30.0 %"));
  EXPECT_THAT(table, HasSubstr("    9.0   0.57  10.0 %"));
  const nlohmann::json json = AdaptiveJson({&result, 1}, 7);
  EXPECT_EQ(json["seed"], 7);
  EXPECT_EQ(json["trials"][0]["planned"]["position_m"], 0.005);
}

}  // namespace
}  // namespace limbcast::tool
