#include "common/sensing/known_rotation.hpp"

#include <cmath>
#include <string>

#include "common/sensing/axis_words.hpp"

namespace limbcast::sensing {
namespace {

// ∫(r − null) dt of all axes from the middle of one rest to the middle of the next (trapezoids).
Eigen::Vector3d SeenRotation(std::span<const MargSample> samples, const RestPose& before,
                             const RestPose& after) {
  const Eigen::Vector3d null = (before.gyro_rad_s + after.gyro_rad_s) / 2.0;
  Eigen::Vector3d seen_rad = Eigen::Vector3d::Zero();
  for (std::size_t i = (before.begin + before.end) / 2; i < (after.begin + after.end) / 2; ++i) {
    const double dt_s = ToSeconds(samples[i + 1].measured_at - samples[i].measured_at);
    const Eigen::Vector3d mean =
        (samples[i].gyro_rad_s + samples[i + 1].gyro_rad_s).cast<double>() / 2.0;
    seen_rad += (mean - null) * dt_s;
  }
  return seen_rad;
}

}  // namespace

Result<Eigen::Vector3d> GyroScalesFromTurns(std::span<const MargSample> samples,
                                            std::span<const RestPose> poses, double known_rad) {
  constexpr double kOwnShare = 0.9;
  constexpr double kLeast_rad = 0.1;  // as GyroScaleFromKnownRotation
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  Eigen::Vector3d turns = Eigen::Vector3d::Zero();
  for (std::size_t i = 0; i + 1 < poses.size(); ++i) {
    const Eigen::Vector3d seen_rad = SeenRotation(samples, poses[i], poses[i + 1]);
    Eigen::Index axis = 0;
    const double own_rad = seen_rad.cwiseAbs().maxCoeff(&axis);
    if (own_rad >= kLeast_rad && own_rad >= kOwnShare * seen_rad.norm()) {
      sum(axis) += known_rad / own_rad;  // Eq. (31)
      turns(axis) += 1.0;
    }
  }
  std::string missing;
  for (Eigen::Index axis = 0; axis < 3; ++axis) {
    if (turns(axis) == 0.0) {
      missing +=
          (missing.empty() ? "" : ", ") + DirectionWords(Eigen::Vector3d::Unit(axis)).substr(1);
    }
  }
  if (!missing.empty()) {
    return Error{ErrorCode::kInvalidArgument,
                 "scale: no known rotation about axis " + missing + " alone, from rest to rest"};
  }
  return Eigen::Vector3d(sum.cwiseQuotient(turns));
}

}  // namespace limbcast::sensing
