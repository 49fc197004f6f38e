// The experiments of Roetenberg 2006, section 6.3, in simulation: what the magnetic + inertial
// filter has to reach. The figures of ten repetitions are those of `limbcast evaluate coil`.
#include "tools/limbcast/evaluate/coil_experiments.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdio>
#include <map>
#include <string>
#include <vector>

#include "common/simulation/random.hpp"
#include "tools/limbcast/evaluate/coil_repetitions.hpp"

namespace limbcast::tool {
namespace {

constexpr int kRepetitions = 4;

struct Aim {
  double forward_mm;
  double smoothed_mm;
};

class CoilExperimentsTest : public testing::Test {
 protected:
  static void SetUpTestSuite() {
    results_ = RepeatCoilExperiments("", simulation::kDefaultSeed, kRepetitions);
    experiments_ = MakeCoilExperiments(simulation::kDefaultSeed);
  }
  static double Mm(const CoilResult& result, CoilMethod method) {
    return 1e3 * result.figures[static_cast<std::size_t>(method)].position_m;
  }

  static std::vector<CoilResult> results_;
  static std::vector<CoilExperiment> experiments_;
};
std::vector<CoilResult> CoilExperimentsTest::results_;
std::vector<CoilExperiment> CoilExperimentsTest::experiments_;

TEST_F(CoilExperimentsTest, AtTheNoiseOfTheThesisTheAimsAreMet) {
  // Of each part of the body, the mean over its experiments.
  const std::map<std::string, Aim> aims = {
      {"bench", {20.0, 8.0}}, {"back", {10.0, 4.0}}, {"arm", {7.0, 2.5}}, {"leg", {14.0, 6.0}}};
  for (const auto& [part, aim] : aims) {
    double forward_mm = 0.0;
    double smoothed_mm = 0.0;
    int count = 0;
    for (const CoilResult& result : results_) {
      if (result.noise == CoilNoise::kThesis && result.experiment.starts_with(part)) {
        forward_mm += Mm(result, CoilMethod::kForward);
        smoothed_mm += Mm(result, CoilMethod::kSmoothed);
        ++count;
        EXPECT_EQ(result.forward.losses, 0) << result.experiment;
        for (const CoilMethod method : {CoilMethod::kForward, CoilMethod::kSmoothed}) {
          EXPECT_LE(result.figures[static_cast<std::size_t>(method)].orientation_rad, 0.01745)
              << result.experiment;
        }
      }
    }
    ASSERT_GT(count, 0) << part;
    std::printf("%-6s forward %5.2f mm, smoothed %5.2f mm\n", part.c_str(), forward_mm / count,
                smoothed_mm / count);
    EXPECT_LE(forward_mm / count, aim.forward_mm) << part;
    EXPECT_LE(smoothed_mm / count, aim.smoothed_mm) << part;
  }
}

TEST_F(CoilExperimentsTest, AtFifteenNanoteslaEveryPublishedPositionIsBeaten) {
  int compared = 0;
  for (const CoilResult& result : results_) {
    if (result.noise != CoilNoise::kModern) {
      continue;
    }
    const auto published =
        std::find_if(experiments_.begin(), experiments_.end(),
                     [&](const CoilExperiment& one) { return one.name == result.experiment; });
    ASSERT_NE(published, experiments_.end());
    EXPECT_LT(std::min(Mm(result, CoilMethod::kForward), Mm(result, CoilMethod::kSmoothed)),
              published->published_fused_mm)
        << result.experiment;
    ++compared;
  }
  EXPECT_EQ(compared, 9);
}

}  // namespace
}  // namespace limbcast::tool
