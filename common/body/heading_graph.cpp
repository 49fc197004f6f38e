#include "common/body/heading_graph.hpp"

#include <Eigen/Cholesky>
#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "common/math/angles.hpp"

namespace limbcast::body {
namespace {

constexpr double kPi = std::numbers::pi;
constexpr double kHuber = 2.0;
constexpr int kIterations = 12;

/// Directions from node 0 outwards over the surest connections (Prim's tree).
std::vector<bool> Start(const std::vector<DirectionObservation>& directions,
                        const std::vector<TurnObservation>& turns, std::vector<double>& x) {
  std::vector<bool> reached(x.size(), false);
  reached[0] = true;
  double best_rad = std::numeric_limits<double>::infinity();
  for (const DirectionObservation& seen : directions) {
    if (seen.node == 0 && seen.sigma_rad < best_rad) {
      best_rad = seen.sigma_rad;
      x[0] = seen.direction_rad;
    }
  }
  while (true) {
    const TurnObservation* surest = nullptr;
    for (const TurnObservation& turn : turns) {
      if (reached[turn.first] != reached[turn.second] &&
          (surest == nullptr || turn.sigma_rad < surest->sigma_rad)) {
        surest = &turn;
      }
    }
    if (surest == nullptr) {
      break;
    }
    if (reached[surest->first]) {
      x[surest->second] = x[surest->first] - surest->turn_rad;
      reached[surest->second] = true;
    } else {
      x[surest->first] = x[surest->second] + surest->turn_rad;
      reached[surest->first] = true;
    }
  }
  if (std::isinf(best_rad)) {  // node 0 saw nothing itself: turn all to what another one saw
    const auto other =
        std::min_element(directions.begin(), directions.end(), [&](const auto& a, const auto& b) {
          const double none = std::numeric_limits<double>::infinity();
          return (reached[a.node] ? a.sigma_rad : none) < (reached[b.node] ? b.sigma_rad : none);
        });
    if (other != directions.end() && reached[other->node]) {
      const double by_rad = other->direction_rad - x[other->node];
      for (double& angle_rad : x) {
        angle_rad += by_rad;
      }
    }
  }
  return reached;
}

class Normal {
 public:
  explicit Normal(std::size_t count)
      : H(Eigen::MatrixXd::Zero(static_cast<Eigen::Index>(count),
                                static_cast<Eigen::Index>(count))),
        g(Eigen::VectorXd::Zero(static_cast<Eigen::Index>(count))),
        squares(count, 0.0),
        seen(count, 0) {}

  /// Residual of x[plus] − x[minus] (minus < 0: of x[plus] alone).
  void Add(std::ptrdiff_t plus, std::ptrdiff_t minus, double residual, double sigma) {
    const double beyond = std::abs(residual) / (kHuber * sigma);
    const double weight = 1.0 / (sigma * sigma * std::max(1.0, beyond));
    H(plus, plus) += weight;
    g(plus) += weight * residual;
    Note(plus, residual / sigma);
    if (minus >= 0) {
      H(minus, minus) += weight;
      H(plus, minus) -= weight;
      H(minus, plus) -= weight;
      g(minus) -= weight * residual;
      Note(minus, residual / sigma);
    }
  }

  Eigen::MatrixXd H;  // NOLINT(readability-identifier-naming): as in normal equations
  Eigen::VectorXd g;
  std::vector<double> squares;  // of residuals over σ, by node
  std::vector<int> seen;

 private:
  void Note(std::ptrdiff_t node, double normalised) {
    squares[static_cast<std::size_t>(node)] += normalised * normalised;
    ++seen[static_cast<std::size_t>(node)];
  }
};

}  // namespace

HeadingGraphSolution SolveHeadingGraph(std::size_t count,
                                       const std::vector<DirectionObservation>& directions,
                                       const std::vector<TurnObservation>& turns) {
  HeadingGraphSolution solution;
  std::vector<double>& x = solution.direction_rad;
  x.assign(count, 0.0);
  const std::vector<bool> reached = Start(directions, turns, x);
  Normal normal(count);
  for (int iteration = 0; iteration < kIterations; ++iteration) {
    normal = Normal(count);
    for (const DirectionObservation& seen : directions) {
      const double residual = std::remainder(seen.direction_rad - x[seen.node], kPi);
      normal.Add(static_cast<std::ptrdiff_t>(seen.node), -1, residual, seen.sigma_rad);
    }
    for (const TurnObservation& turn : turns) {
      normal.Add(static_cast<std::ptrdiff_t>(turn.first), static_cast<std::ptrdiff_t>(turn.second),
                 math::WrappedAngle_rad(turn.turn_rad - (x[turn.first] - x[turn.second])),
                 turn.sigma_rad);
    }
    // A node that nothing is known of stays where it is.
    normal.H.diagonal().array() += 1.0 / (kPi * kPi);
    const Eigen::VectorXd step = normal.H.ldlt().solve(normal.g);
    for (std::size_t i = 0; i < count; ++i) {
      x[i] = math::WrappedAngle_rad(x[i] + step[static_cast<Eigen::Index>(i)]);
    }
  }
  const Eigen::MatrixXd cov =
      normal.H.ldlt().solve(Eigen::MatrixXd::Identity(normal.H.rows(), normal.H.cols()));
  for (std::size_t i = 0; i < count; ++i) {
    const auto row = static_cast<Eigen::Index>(i);
    solution.sigma_rad.push_back(reached[i] ? std::min(kPi, std::sqrt(cov(row, row))) : kPi);
    solution.misfit.push_back(normal.seen[i] == 0 ? 0.0
                                                  : std::sqrt(normal.squares[i] / normal.seen[i]));
  }
  return solution;
}

}  // namespace limbcast::body
