#pragma once

#include <cstddef>
#include <vector>

namespace limbcast::body {

/// A direction that was seen in the earth frame of one sensor.
struct DirectionObservation {
  std::size_t node = 0;
  double direction_rad = 0.0;  ///< of a line: forward and backward are the same
  double sigma_rad = 0.1;      ///< > 0
};

/// Two frames seen turned against each other: direction(first) = direction(second) + turn.
struct TurnObservation {
  std::size_t first = 0;
  std::size_t second = 0;
  double turn_rad = 0.0;
  double sigma_rad = 0.1;  ///< > 0
};

/// One direction as seen in the frame of each node, all the same way along its line.
struct HeadingGraphSolution {
  std::vector<double> direction_rad;  ///< in (−π, π]
  std::vector<double> sigma_rad;      ///< π for a node that nothing connects with node 0
  std::vector<double> misfit;         ///< rms of a node's residuals over their σ, 1 = as promised
};

/// Weighted least squares on the circle for the one horizontal direction that all observations are
/// about. Starts from the connections with the least σ outwards from node 0, which settles the way
/// along the line for all others, then iterates with Huber weights (a residual beyond 2 σ counts
/// less). `count` ≥ 1.
[[nodiscard]] HeadingGraphSolution SolveHeadingGraph(
    std::size_t count, const std::vector<DirectionObservation>& directions,
    const std::vector<TurnObservation>& turns);

}  // namespace limbcast::body
