#pragma once

#include <Eigen/Core>
#include <span>
#include <vector>

#include "common/base/result.hpp"
#include "common/simulation/random.hpp"

namespace limbcast::simulation {

/// What an optical system makes of the markers of one person (design/position.md section 4).
struct MarkerErrors {
  double sigma_m = 0.3e-3;   ///< white noise of one axis. Range: [0, 0.1]
  double gap_rate_hz = 0.0;  ///< a marker is hidden so often, and each time for
  double gap_s = 0.5;        ///< ... so long. Range: [0, 100], [0, 100]
  /// Part of the samples that show something else within ghost_distance_m. Range: [0, 1], (0, 10]
  double ghost_rate = 0.0;
  double ghost_distance_m = 0.3;
  double swap_rate_hz = 0.0;  ///< two markers change names so often, and each time for
  double swap_s = 0.2;        ///< ... so long. Range: [0, 100], [0, 100]
};
[[nodiscard]] Status Validate(const MarkerErrors& errors);

/// One marker as the cameras report it.
struct SeenMarker {
  Eigen::Vector3d p_earth_marker_m = Eigen::Vector3d::Zero();
  bool visible = true;
};

/// The markers of one person as cameras report them, frame by frame:
///
///   z = p + n ,  hidden in gaps, p another marker's while two are swapped, a ghost now and then
///
/// Gaps and swaps begin as a Poisson process. Allocates at construction only. Thread-compatible.
class MarkerModel {
 public:
  MarkerModel(const MarkerErrors& errors, std::size_t markers, const Random& random);

  /// What is seen of `p_earth_m` (one for each marker), `dt_s` after the last frame. Valid until
  /// the next call.
  [[nodiscard]] std::span<const SeenMarker> See(std::span<const Eigen::Vector3d> p_earth_m,
                                                double dt_s);

 private:
  [[nodiscard]] bool Begins(double rate_hz, double dt_s);

  MarkerErrors errors_;
  Random random_;
  std::vector<double> hidden_s_;  // still to come, by marker
  std::size_t swapped_ = 0;       // with the next one
  double swapped_s_ = 0.0;        // still to come
  std::vector<SeenMarker> seen_;
};

}  // namespace limbcast::simulation
