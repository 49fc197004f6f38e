#include "common/simulation/ground_path.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "common/base/expects.hpp"
#include "common/simulation/smooth_step.hpp"

namespace limbcast::simulation {
namespace {

constexpr double kCell_m = 0.25;

// Gauss-Legendre, eight points on [−1, 1] (Abramowitz & Stegun, Table 25.4); symmetric.
constexpr std::array<double, 4> kNode = {0.1834346424956498, 0.5255324099163290, 0.7966664774136267,
                                         0.9602898564975363};
constexpr std::array<double, 4> kWeight = {0.3626837833783620, 0.3137066458778873,
                                           0.2223810344533745, 0.1012285362903763};

template <typename Cell>
Jet Heading(const Cell& cell, const Jet& u_m) {
  return cell.from_rad +
         cell.turn_rad * QuickStep((u_m - cell.piece_start_m) * (1.0 / cell.piece_length_m));
}

// Where the cell's curve is at u_m, by integrating its heading from the cell's start.
template <typename Cell>
std::array<double, 2> Integrate(const Cell& cell, double u_m) {
  const double half_m = 0.5 * (u_m - cell.start_m);
  const double middle_m = 0.5 * (u_m + cell.start_m);
  std::array<double, 2> p_m = {cell.x_m, cell.y_m};
  for (std::size_t i = 0; i < kNode.size(); ++i) {
    for (const double node : {kNode[i], -kNode[i]}) {
      const double heading_rad = Heading(cell, Jet{middle_m + half_m * node}).value;
      p_m[0] += half_m * kWeight[i] * std::cos(heading_rad);
      p_m[1] += half_m * kWeight[i] * std::sin(heading_rad);
    }
  }
  return p_m;
}

}  // namespace

FloorPose Compose(const FloorPose& frame, const FloorPose& local) {
  const double c = std::cos(frame.heading_rad);
  const double s = std::sin(frame.heading_rad);
  return {frame.x_m + c * local.x_m - s * local.y_m, frame.y_m + s * local.x_m + c * local.y_m,
          frame.heading_rad + local.heading_rad};
}

GroundPath::GroundPath(const FloorPose& start, std::span<const PathPiece> pieces) {
  Expects(!pieces.empty(), "a path of one piece or more");
  FloorPose at = start;
  for (const PathPiece& piece : pieces) {
    Expects(piece.length_m > 0.0, "a piece longer than nothing");
    const int count = static_cast<int>(std::ceil(piece.length_m / kCell_m));
    for (int i = 0; i < count; ++i) {
      const Cell cell{.start_m = length_m_ + piece.length_m * i / count,
                      .x_m = at.x_m,
                      .y_m = at.y_m,
                      .piece_start_m = length_m_,
                      .piece_length_m = piece.length_m,
                      .from_rad = at.heading_rad,
                      .turn_rad = piece.turn_rad};
      const auto end_m = Integrate(cell, length_m_ + piece.length_m * (i + 1) / count);
      at.x_m = end_m[0];
      at.y_m = end_m[1];
      cells_.push_back(cell);
    }
    at.heading_rad += piece.turn_rad;
    length_m_ += piece.length_m;
  }
}

MovingFloorPose GroundPath::At(const Jet& u_m) const {
  Expects(!cells_.empty(), "a path with pieces");
  const auto after = std::upper_bound(cells_.begin() + 1, cells_.end(), u_m.value,
                                      [](double u, const Cell& cell) { return u < cell.start_m; });
  const Cell& cell = *(after - 1);
  const double on_path_m = std::clamp(u_m.value, 0.0, length_m_);
  auto p_m = Integrate(cell, on_path_m);
  const Jet heading_rad = Heading(cell, u_m);
  const double c = std::cos(heading_rad.value);
  const double s = std::sin(heading_rad.value);
  p_m[0] += (u_m.value - on_path_m) * c;
  p_m[1] += (u_m.value - on_path_m) * s;
  const double rate = u_m.rate;
  const double bend = rate * heading_rad.rate;
  return {{p_m[0], rate * c, u_m.accel * c - bend * s},
          {p_m[1], rate * s, u_m.accel * s + bend * c},
          heading_rad};
}

FloorPose GroundPath::end() const {
  const MovingFloorPose last = At(Jet{length_m_});
  return {last.x_m.value, last.y_m.value, last.heading_rad.value};
}

}  // namespace limbcast::simulation
