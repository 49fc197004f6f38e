#include "common/body/heading_graph.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace limbcast::body {
namespace {

constexpr double kPi = std::numbers::pi;

double Between_rad(double a, double b) { return std::abs(std::remainder(a - b, 2.0 * kPi)); }

TEST(HeadingGraphTest, ChainsOfTurnsSettleWhichWayAlongTheLineIsMeant) {
  const std::vector<double> truth{0.4, -2.9, 2.2, 1.0};
  std::vector<DirectionObservation> directions;
  std::vector<TurnObservation> turns;
  for (std::size_t i = 0; i < truth.size(); ++i) {
    // Every second line is given the other way round.
    directions.push_back({i, truth[i] + (i % 2 == 0 ? 0.0 : kPi), 0.1});
  }
  for (std::size_t i = 1; i < truth.size(); ++i) {
    turns.push_back({i - 1, i, truth[i - 1] - truth[i] + 0.3, 0.5});  // poor, but not that poor
  }
  const HeadingGraphSolution solution = SolveHeadingGraph(truth.size(), directions, turns);
  for (std::size_t i = 0; i < truth.size(); ++i) {
    EXPECT_LT(Between_rad(solution.direction_rad[i], truth[i]), 0.05) << i;
    EXPECT_LT(solution.sigma_rad[i], 0.1) << "two observations are surer than one";
  }
}

TEST(HeadingGraphTest, AnOutlierCountsLess) {
  const HeadingGraphSolution solution =
      SolveHeadingGraph(1, {{0, 0.5, 0.1}, {0, 0.52, 0.1}, {0, 0.48, 0.1}, {0, 1.5, 0.1}}, {});
  EXPECT_LT(std::abs(solution.direction_rad[0] - 0.5), 0.15) << "the plain mean is 0.75";
  EXPECT_GT(solution.misfit[0], 2.0) << "and the disagreement shows";
}

TEST(HeadingGraphTest, WeightsAreThoseOfTheSigmas) {
  const HeadingGraphSolution solution = SolveHeadingGraph(1, {{0, 0.0, 0.1}, {0, 0.15, 0.2}}, {});
  EXPECT_NEAR(solution.direction_rad[0], 0.15 * 0.2, 1e-3);  // 25 : 100
  EXPECT_NEAR(solution.sigma_rad[0], 1.0 / std::sqrt(125.0), 1e-3);
}

TEST(HeadingGraphTest, ANodeThatNothingConnectsIsUnknown) {
  const HeadingGraphSolution solution = SolveHeadingGraph(3, {{0, 0.5, 0.1}}, {{0, 1, 0.2, 0.1}});
  EXPECT_NEAR(solution.direction_rad[1], 0.3, 0.01);
  EXPECT_GT(solution.sigma_rad[2], 3.0);
}

TEST(HeadingGraphTest, WithoutADirectionOfItsOwnTheFirstNodeTakesItFromAnother) {
  const HeadingGraphSolution solution = SolveHeadingGraph(2, {{1, 1.0, 0.1}}, {{0, 1, 0.7, 0.1}});
  EXPECT_LT(std::abs(std::remainder(solution.direction_rad[0] - 1.7, kPi)), 0.01);
}

}  // namespace
}  // namespace limbcast::body
