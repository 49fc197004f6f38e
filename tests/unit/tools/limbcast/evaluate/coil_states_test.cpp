#include "tools/limbcast/evaluate/coil_states.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

namespace limbcast::tool {
namespace {

using ::testing::HasSubstr;

const CoilStatesResult::Figures& Of(const CoilStatesResult& result, CoilStates states) {
  return result.figures[static_cast<std::size_t>(states)];
}

TEST(CoilStatesTest, TheSourcesCompassGainsOnAWalkersBack) {
  constexpr std::size_t kBackWalking = 4;
  const CoilStatesResult result = EvaluateCoilStates(kBackWalking, CoilNoise::kThesis, 3, 1);
  EXPECT_EQ(result.experiment, "back walking");
  EXPECT_EQ(result.repetitions, 1);
  const auto& before = Of(result, CoilStates::kGradient);
  const auto& with = Of(result, CoilStates::kCompass);
  EXPECT_LT(with.forward_m, 0.9 * before.forward_m);
  EXPECT_LT(with.forward_rad, before.forward_rad);
  for (const CoilStatesResult::Figures& figures : result.figures) {
    EXPECT_LT(figures.smoothed_m, figures.forward_m);
    EXPECT_LT(figures.nees, 2.0);
  }
}

TEST(CoilStatesTest, TheTableAndTheFileHaveEveryFilter) {
  CoilStatesResult result;
  result.experiment = "leg walking";
  result.repetitions = 10;
  result.figures[3] = {.forward_m = 0.0105, .smoothed_m = 0.0048, .forward_rad = 0.01, .nees = 0.3};
  const std::string table = CoilStatesTable({&result, 1});
  EXPECT_THAT(table, HasSubstr("leg walking"));
  EXPECT_THAT(table, HasSubstr("+ source's compass"));
  EXPECT_THAT(table, HasSubstr(" 10.5 /  4.8   0.57  0.3"));
  const nlohmann::json json = CoilStatesJson({&result, 1}, 7);
  EXPECT_EQ(json["seed"], 7);
  EXPECT_EQ(json["trials"][0]["repetitions"], 10);
  EXPECT_EQ(json["trials"][0]["+ source's compass"]["forward_m"], 0.0105);
}

}  // namespace
}  // namespace limbcast::tool
