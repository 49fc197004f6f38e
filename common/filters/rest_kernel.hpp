#pragma once

#include <numbers>

#include "common/filters/gauss_newton_kernel.hpp"

namespace limbcast::filters::kernel {

/// The arithmetic of RestDetector and FieldMonitor, for one sensor or several (lanes.hpp).

inline constexpr double kRestAfter_s = 1.5;

/// Nothing but T, flags too.
template <typename T>
struct Rest {
  Vector<T> low_gyro_rad_s;
  Vector<T> low_accel_m_s2;
  T still_s;
  T started;
};

/// One sample; see RestDetector.
template <typename T>
inline void UpdateRest(const Vector<T>& gyro_rad_s, const Vector<T>& accel_m_s2,
                       const Vector<T>& gyro_bias_rad_s, T dt_s, Rest<T>& rest) {
  constexpr double kLowPass_s = 0.5;
  constexpr double kStillGyro_rad_s = 2.0 * std::numbers::pi / 180.0;
  constexpr double kStillAccel_m_s2 = 0.5;
  const auto started = lanes::IsSet(rest.started);
  Vector<T> low_g = Select<T>(started, rest.low_gyro_rad_s, gyro_rad_s);
  Vector<T> low_a = Select<T>(started, rest.low_accel_m_s2, accel_m_s2);
  const T gain = lanes::Min(T(dt_s * T(1.0 / kLowPass_s)), T(1));
  low_g = low_g + Scaled(gyro_rad_s - low_g, gain);
  low_a = low_a + Scaled(accel_m_s2 - low_a, gain);
  const Vector<T> shaken_g = gyro_rad_s - low_g;
  const Vector<T> shaken_a = accel_m_s2 - low_a;
  const Vector<T> turning = low_g - gyro_bias_rad_s;
  constexpr double kGyro2 = kStillGyro_rad_s * kStillGyro_rad_s;
  const lanes::MaskOf<T> steady(
      lanes::Both(Dot(shaken_g, shaken_g) < T(kGyro2),
                  Dot(shaken_a, shaken_a) < T(kStillAccel_m_s2 * kStillAccel_m_s2)));
  const lanes::MaskOf<T> still(lanes::Both(steady, Dot(turning, turning) < T(kGyro2)));
  rest.low_gyro_rad_s = low_g;
  rest.low_accel_m_s2 = low_a;
  rest.still_s = lanes::Select(still, T(rest.still_s + dt_s), T(0));
  rest.started = T(1);
}

/// New mean square deviation of the field; see FieldMonitor.
template <typename T>
[[nodiscard]] inline T MeanSquareDeviation(T mean_square, T norm2, T vertical, T reference_vertical,
                                           T dt_s) {
  constexpr double kAverage_s = 0.3;
  constexpr double kMostSquare = 4.0;  // so that one absurd reading is forgotten in two seconds
  const T norm_error = T(0.5) * (norm2 - T(1));  // |m| − 1 to first order, without a root
  const T vertical_error = vertical - reference_vertical;
  const T square =
      lanes::Min(T(norm_error * norm_error + vertical_error * vertical_error), T(kMostSquare));
  const T gain = lanes::Min(T(dt_s * T(1.0 / kAverage_s)), T(1));
  return mean_square + gain * (square - mean_square);
}

}  // namespace limbcast::filters::kernel
