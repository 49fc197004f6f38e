#include "tools/limbcast/evaluate/coil_trial.hpp"

#include <gtest/gtest.h>

namespace limbcast::tool {
namespace {

const CoilFigure& FigureOf(const CoilResult& result, CoilMethod method) {
  return result.figures[static_cast<std::size_t>(method)];
}

TEST(CoilTrialTest, EachMethodIsBetterThanTheOneBefore) {
  const auto experiments = MakeCoilExperiments(1);
  const CoilResult result = EvaluateCoil(experiments[3], CoilNoise::kThesis, 1);  // back rotation
  EXPECT_DOUBLE_EQ(result.forward.tracked, 1.0);
  EXPECT_EQ(result.forward.losses, 0);
  const double forward_m = FigureOf(result, CoilMethod::kForward).position_m;
  const double loose_m = FigureOf(result, CoilMethod::kLoose).position_m;
  EXPECT_DOUBLE_EQ(result.loose.tracked, 1.0);
  EXPECT_LT(loose_m, FigureOf(result, CoilMethod::kMagneticOnly).position_m);
  EXPECT_LT(forward_m, loose_m);
  EXPECT_LT(FigureOf(result, CoilMethod::kFixedLag).position_m, forward_m);
  EXPECT_LT(FigureOf(result, CoilMethod::kSmoothed).position_m, forward_m);
  EXPECT_LT(forward_m, 0.010);
  EXPECT_LT(FigureOf(result, CoilMethod::kForward).orientation_rad, 0.0175);
  EXPECT_LT(FigureOf(result, CoilMethod::kForward).distance_m, forward_m);
}

TEST(CoilTrialTest, ALowerNoiseGivesLessErrorThanPublished) {
  const auto experiments = MakeCoilExperiments(1);
  const CoilExperiment& leg = experiments.back();
  const CoilResult result = EvaluateCoil(leg, CoilNoise::kModern, 1);
  EXPECT_LT(1e3 * FigureOf(result, CoilMethod::kSmoothed).position_m, leg.published_fused_mm);
}

}  // namespace
}  // namespace limbcast::tool
