#pragma once

#include <Eigen/Core>
#include <array>

#include "common/base/result.hpp"
#include "common/body/body_definition.hpp"
#include "common/body/segment.hpp"

namespace limbcast::simulation {

/// The bones of the simulated person: the same numbers as a BodyDefinition with all 23 segments, in
/// a form made for computing. Legs are straight down in the reference pose.
struct PersonShape {
  /// Inboard end in the parent's axes (zero for the pelvis), by body::Index.
  std::array<Eigen::Vector3d, body::kSegmentCount> p_parent_segment_m;
  /// Outboard end in the segment's own axes.
  std::array<Eigen::Vector3d, body::kSegmentCount> p_segment_end_m;
  double upper_leg_m = 0.0;
  double lower_leg_m = 0.0;
  double ankle_height_m = 0.0;  ///< ankle over the sole
  double ball_forward_m = 0.0;  ///< toe joint before the ankle
  double ball_height_m = 0.0;   ///< toe joint over the sole
  double heel_back_m = 0.0;     ///< heel behind the ankle
  double hip_half_m = 0.0;      ///< hip joint centre beside the middle

  [[nodiscard]] double leg_m() const { return upper_leg_m + lower_leg_m; }
};

/// The bones of `body`. Fails unless it has all 23 segments with straight legs that are alike on
/// both sides (1 mm), each 0.2 to 0.7 m long.
[[nodiscard]] Result<PersonShape> MakePersonShape(const body::BodyDefinition& body);

/// The bones of an average person of this height (common/body/default_body.hpp). Fails unless
/// height_m is in [1.2, 2.2].
[[nodiscard]] Result<PersonShape> MakePersonShape(double height_m);

}  // namespace limbcast::simulation
