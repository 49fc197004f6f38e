#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <optional>

namespace limbcast::filters {

/// Where a sensor may be. The fields of concentric coils are the same at p and −p
/// (design/position.md section 9): nine values cannot tell them apart, something else must.
struct HemisphereRule {
  /// Tracking: the nearer of the two is taken.
  std::optional<Eigen::Vector3d> predicted_emitter_m;
  /// Start: unit vector in emitter axes that points into the half where the sensor is.
  std::optional<Eigen::Vector3d> half_space;
  /// No start this close to the plane between the halves.
  double boundary_rad = 0.35;
};

enum class Hemisphere : std::uint8_t {
  kAsGiven,    ///< p
  kOpposite,   ///< −p
  kUndecided,  ///< neither rule says which: near the boundary, or there is no rule
};

/// Which of p and −p is the sensor.
[[nodiscard]] Hemisphere HemisphereOf(const HemisphereRule& rule,
                                      const Eigen::Vector3d& p_emitter_m);

}  // namespace limbcast::filters
