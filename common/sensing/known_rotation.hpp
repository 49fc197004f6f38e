#pragma once

#include <Eigen/Core>
#include <span>

#include "common/base/result.hpp"
#include "common/sensing/rest_poses.hpp"

namespace limbcast::sensing {

/// Scale factors of the gyro by the papers' procedure (Eq. 31, GyroScaleFromKnownRotation): the
/// sensor was turned through `known_rad` about one of its axes at a time, from rest to rest. A turn
/// counts for the axis that holds at least 90 % of what the gyro saw; with more turns about an axis
/// the mean is taken. The axes' misalignment k makes an error of k²/2 at most, a turn about an axis
/// that is off by θ one of 1 − cos θ.
///
/// @param poses      from FindRestPoses(samples); their means are the nulls.
/// @param known_rad  size of each turn, in (0, 20π].
/// kInvalidArgument names the axes that were not turned.
[[nodiscard]] Result<Eigen::Vector3d> GyroScalesFromTurns(std::span<const MargSample> samples,
                                                          std::span<const RestPose> poses,
                                                          double known_rad);

}  // namespace limbcast::sensing
