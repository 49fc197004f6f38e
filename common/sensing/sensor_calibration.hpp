#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "common/base/result.hpp"
#include "common/base/time.hpp"
#include "common/sensing/marg_sample.hpp"

namespace limbcast::sensing {

/// What turns the raw reading of a three-axis sensor into the true one:
///
///   y = M (r − b)
///
/// M holds scale factors (diagonal) and axis misalignment or soft iron, b the null point or hard
/// iron, in the unit of the reading.
///
/// Tedaldi, Pretto, Menegatti, "A robust and easy to implement method for IMU calibration without
/// external equipments", ICRA 2014, Eq. (8)–(10); for the magnetometer Vasconcelos et al.,
/// "Geometric approach to strapdown magnetometer calibration in sensor frame", IEEE TAES 47 (2011),
/// Eq. (7).
struct TriadCalibration {
  Eigen::Matrix3d matrix = Eigen::Matrix3d::Identity();
  Eigen::Vector3d offset = Eigen::Vector3d::Zero();

  [[nodiscard]] Eigen::Vector3d Apply(const Eigen::Vector3d& raw) const {
    return matrix * (raw - offset);
  }
};

/// How far a fit may be trusted.
enum class CalibrationGrade : std::uint8_t {
  kGood,    ///< sigma of the scale ≤ 0.1 % and residual ≤ 0.5 %
  kFair,    ///< sigma ≤ 0.2 % and residual ≤ 1.5 %: fit for use
  kUsable,  ///< accepted, but a second try will pay
};
[[nodiscard]] std::string_view ToText(CalibrationGrade grade);

/// A calibration of one triad with what is known of its quality. Residuals are RMS: for the
/// accelerometer and the magnetometer of |y|/norm − 1 (dimensionless), for the gyro of the angle
/// (rad) between a direction it carried along and the same direction measured.
struct TriadFit {
  TriadCalibration calibration;
  std::string method;            ///< at most 32 characters, e.g. "ellipsoid"
  double residual_before = 0.0;  ///< with the raw readings
  double residual_after = 0.0;
  double sigma_scale = 0.0;  ///< 1-sigma of the least certain element of the matrix
  double sigma_offset =
      0.0;  ///< 1-sigma of the least certain offset, fraction of the norm (gyro: rad/s)
  double coverage = 0.0;   ///< share of the sphere of directions seen; gyro: of the turns needed
  std::size_t points = 0;  ///< equations that went into the fit
};
[[nodiscard]] CalibrationGrade GradeOf(const TriadFit& fit);

/// All that is known of one sensor's errors; a channel without a fit stays as it is.
struct SensorCalibration {
  std::string serial;  ///< the sensor it belongs to, at most 64 characters
  Time calibrated_at{};
  double temperature_celsius = 0.0;  ///< mean while measuring; NaN = not known
  std::optional<TriadFit> gyro;      ///< rad/s
  std::optional<TriadFit> accel;     ///< m/s²
  std::optional<TriadFit> mag;       ///< tesla

  [[nodiscard]] bool empty() const { return !gyro && !accel && !mag; }

  /// Corrects the readings that are there; flags, times and the rest stay. Readings that are not
  /// finite stay so.
  void Apply(MargSample& sample) const;

  /// What `sensor_info` says is in force: the channels and their grades, e.g.
  /// "gyro good, accel good, mag fair"; "" for an empty one. At most 64 characters.
  [[nodiscard]] std::string Summary() const;
};

/// The first value that cannot be: not finite, a matrix that is singular or far from a sensor's
/// (determinant outside [0.1, 10]). kCorruptData, naming the key.
[[nodiscard]] Status Validate(const SensorCalibration& calibration);

}  // namespace limbcast::sensing
