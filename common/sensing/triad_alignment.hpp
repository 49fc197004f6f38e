#pragma once

#include <Eigen/Geometry>
#include <span>

#include "common/base/result.hpp"

namespace limbcast::sensing {

/// Corrected accelerometer and magnetometer means of one time at rest.
struct GravityAndField {
  Eigen::Vector3d accel_m_s2;
  Eigen::Vector3d mag_tesla;
};

/// Where the axes of a magnetometer are turned to against those of the accelerometer.
struct AxisAlignment {
  Eigen::Matrix3d R_accel_mag =
      Eigen::Matrix3d::Identity();  ///< field in accelerometer axes = R·field
  double dip_rad = 0.0;             ///< of the field below the horizontal, downwards positive
  double sigma_rad = 0.0;           ///< 1-sigma of the least certain axis of R
  double residual_before =
      0.0;  ///< RMS of the angle between field and horizontal around its mean, rad
  double residual_after = 0.0;
};

/// Turns the magnetometer until the angle between field and gravity is the same in all poses:
/// aᵢᵀ R mᵢ = −sin(dip) for unit aᵢ (up) and mᵢ. Lengths say nothing of this rotation, so it comes
/// after the two ellipsoid fits. Gauss–Newton from R = I: the axes may be off by some 30°.
///
/// Kok, Schön, "Magnetometer calibration using inertial sensors", IEEE Sensors J. 16 (2016), Eq.
/// (17) (their initial estimate of the alignment).
///
/// Refused with fewer than 8 poses or when 1-sigma of R is above `max_sigma_rad`.
[[nodiscard]] Result<AxisAlignment> AlignMagToAccel(std::span<const GravityAndField> poses,
                                                    double max_sigma_rad);

/// The rotation that turns corrected accelerometer readings so that the six positions of the
/// sensor's case on a level surface read along its axes (Kabsch, "A solution for the best rotation
/// to relate two sets of vectors", Acta Cryst. A32 (1976)). Readings within 15° of an axis count.
/// Refused when one of the six is missing, naming them.
[[nodiscard]] Result<Eigen::Matrix3d> AlignToCase(std::span<const Eigen::Vector3d> accel_m_s2);

}  // namespace limbcast::sensing
