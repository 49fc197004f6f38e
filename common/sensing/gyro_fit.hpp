#pragma once

#include <Eigen/Core>
#include <span>
#include <vector>

#include "common/base/result.hpp"
#include "common/sensing/marg_sample.hpp"
#include "common/sensing/sensor_calibration.hpp"

namespace limbcast::sensing {

/// A stretch of gyro readings between two looks at one direction that stands still in the earth
/// frame (gravity at rest, or the earth field): samples [begin, end], the direction in corrected
/// sensor axes at both ends (unit), and the null of the gyro meanwhile.
struct CarriedDirection {
  std::size_t begin = 0;
  std::size_t end = 0;
  Eigen::Vector3d before = Eigen::Vector3d::UnitZ();
  Eigen::Vector3d after = Eigen::Vector3d::UnitZ();
  Eigen::Vector3d null_before_rad_s = Eigen::Vector3d::Zero();  ///< straight line in between
  Eigen::Vector3d null_after_rad_s = Eigen::Vector3d::Zero();
};

struct GyroFitConfig {
  /// Refused when 1-sigma of an element of M is more. Range: (0, 1].
  double max_sigma = 0.003;
  /// Refused when the RMS angle after the fit is more. Range: (0, 1].
  double max_residual_rad = 0.05;
  /// Each axis must turn this much in all (both ways added), else it is named. Range: [0.1, 1000].
  double min_turn_rad = 6.2832;
};

/// Fits the nine elements of M so that the directions, carried along by ω = M (r − null), arrive
/// where they are seen: `after` = R(ω)ᵀ·`before`. The corrected axes are those of the directions
/// (the accelerometer's), so scale, misalignment and the turn against the accelerometer come out
/// together. Tedaldi et al. 2014, Eq. (12)–(17), with the exponential map in place of Runge–Kutta
/// and rates at the middle of the samples; nulls from rest (ibid., section V).
///
/// kInvalidArgument names what is missing: stretches, or turns about an axis.
[[nodiscard]] Result<TriadFit> FitGyro(std::span<const MargSample> samples,
                                       std::span<const CarriedDirection> carried,
                                       const GyroFitConfig& config);

/// `before` carried along through the samples of `carried` (unit).
[[nodiscard]] Eigen::Vector3d CarryDirection(std::span<const MargSample> samples,
                                             const CarriedDirection& carried,
                                             const Eigen::Matrix3d& matrix);

}  // namespace limbcast::sensing
