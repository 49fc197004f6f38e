#pragma once

#include <Eigen/Core>

#include "common/base/result.hpp"

namespace limbcast::sensing {

/// Frequency multiplex: the three coils are on together, each with its own tone (design/position.md
/// section 7). The gyro takes rotation out of what is slower than kLowestTone_hz; above the highest
/// the magnetometer's own filter weakens the tone.
struct CoilTones {
  static constexpr double kLowestTone_hz = 15.0;
  static constexpr double kHighestOfRate = 0.4;  ///< of the magnetometer's rate

  /// Of coils X, Y, Z. Range: [15 Hz, 0.4 of the magnetometer's rate], 2 / window_s apart
  Eigen::Vector3d frequency_hz{18.0, 29.0, 40.0};
  /// With the default the coils heat as much as with the thesis' pulses: 3 a²/2 = 3 (60 ms/600 ms)
  /// (1.5 A)². Range: (0, 20]
  double amplitude_a = 0.67;
  /// So long is looked at for a pose without a track. Range: [0.05, 2]
  double window_s = 0.2;
};

/// @param rate_hz  of the magnetometer.
[[nodiscard]] Status Validate(const CoilTones& tones, double rate_hz);

/// Current in each coil, i_c(t) = a sin(2π f_c t).
///
/// @param t_s  by the clock of the source.
[[nodiscard]] Eigen::Vector3d ToneCurrents_a(const CoilTones& tones, double t_s);

}  // namespace limbcast::sensing
