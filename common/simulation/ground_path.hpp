#pragma once

#include <span>
#include <vector>

#include "common/simulation/jet.hpp"

namespace limbcast::simulation {

/// A place on the floor and the way someone there faces (counter-clockwise from x).
struct FloorPose {
  double x_m = 0.0;
  double y_m = 0.0;
  double heading_rad = 0.0;
};

/// The same, moving.
struct MovingFloorPose {
  Jet x_m;
  Jet y_m;
  Jet heading_rad;
};

/// `local`, given in the axes of `frame`, in the axes in which `frame` is given.
[[nodiscard]] FloorPose Compose(const FloorPose& frame, const FloorPose& local);

/// Straight on (turn_rad = 0) or round a bend: the heading changes by turn_rad (left positive).
struct PathPiece {
  double length_m = 1.0;
  double turn_rad = 0.0;
};

/// A curve on the floor by its heading ψ as a function of the length u walked; x' = cos ψ,
/// y' = sin ψ. Within a bend ψ follows the quick step of smooth_step.hpp, so that curvature and its
/// slope have no jump anywhere; u is exactly the length.
class GroundPath {
 public:
  GroundPath() = default;
  /// Begins at `start`; every piece longer than nothing.
  GroundPath(const FloorPose& start, std::span<const PathPiece> pieces);

  [[nodiscard]] double length_m() const { return length_m_; }
  /// Where the curve is after u_m, faced along its tangent. Before 0 and after length_m() it is
  /// straight.
  [[nodiscard]] MovingFloorPose At(const Jet& u_m) const;
  [[nodiscard]] FloorPose end() const;

 private:
  // A short stretch over which eight Gauss points integrate cos ψ to rounding.
  struct Cell {
    double start_m = 0.0;
    double x_m = 0.0;
    double y_m = 0.0;
    double piece_start_m = 0.0;
    double piece_length_m = 1.0;
    double from_rad = 0.0;
    double turn_rad = 0.0;
  };
  std::vector<Cell> cells_;
  double length_m_ = 0.0;
};

}  // namespace limbcast::simulation
