#pragma once

#include <Eigen/Core>
#include <span>

#include "common/base/result.hpp"
#include "common/sensing/sensor_calibration.hpp"

/// The calibration procedures of the papers, exactly: a null point and a scale factor for each
/// axis, no misalignment. Bachmann, McGhee, Yun, Zyda, "Inertial and magnetic posture tracking for
/// inserting humans into networked virtual environments", VRST 2001, section 3.2.1, Eq. (29)–(31).
namespace limbcast::sensing {

/// One axis: y = scale · (r − null).
struct NullAndScale {
  double null = 0.0;
  double scale = 1.0;
};

/// From the readings of an axis held along a known vector of length `units` and against it:
///
///   null  = (max + min)/2             Eq. (29)
///   scale = 2·units/(max − min)       Eq. (30)
///
/// With both positions within θ of the vertical, the scale is at most 1/cos θ too large (0.4 % at
/// 5°), and with noise σ of a mean the null is σ/√2 uncertain. kInvalidArgument when max ≤ min.
[[nodiscard]] Result<NullAndScale> NullAndScaleFrom(double max, double min, double units);

/// Six positions: the largest and the smallest of `means` (mean readings at rest, m/s²) of each
/// axis. Refused when an axis has not been held up and down (a reading beyond ±0.8 g), naming the
/// positions that are missing.
[[nodiscard]] Result<TriadCalibration> SixPositionAccel(std::span<const Eigen::Vector3d> means,
                                                        double gravity_m_s2);

/// The magnetometer's largest and smallest reading of each axis while it is turned every way. The
/// scale makes all axes read ±field_tesla; 0 takes the mean of the three half ranges (the sensor's
/// own overall scale). With N readings of noise σ the extremes lie about σ√(2 ln N) too far out;
/// that leaves the null alone and makes the scale too small by this over the field. Refused with
/// fewer than 6 readings or when an axis spans less than half of the widest.
[[nodiscard]] Result<TriadCalibration> MinMaxMag(std::span<const Eigen::Vector3d> readings,
                                                 double field_tesla);

/// Null points of the gyro: the mean of its readings at rest (rad/s). At least one reading.
[[nodiscard]] Eigen::Vector3d GyroNull(std::span<const Eigen::Vector3d> readings_at_rest);

/// One axis' scale from a rotation through a known angle:
///
///   scale = known rotation/estimated rotation        Eq. (31)
///
/// where the estimated one is ∫(r − null) dt with a scale of one. An error of the null δ spoils it
/// by δ·T/known, noise of density n by n·√(T/2)/known. kInvalidArgument when the estimated rotation
/// is below 0.1 rad or has the other sign.
[[nodiscard]] Result<double> GyroScaleFromKnownRotation(double known_rad,
                                                        std::span<const double> readings_rad_s,
                                                        double null_rad_s, double dt_s);

}  // namespace limbcast::sensing
