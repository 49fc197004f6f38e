#pragma once

#include <numbers>

namespace limbcast::units {

/// The factors between SI and what files, screens and vendors use. Every function takes a number or
/// an Eigen vector or matrix and returns the same type; nothing else in the project spells out
/// these numbers. Thread-safe.

/// Standard gravity, exact by definition (CGPM 1901).
inline constexpr double kStandardGravity_m_s2 = 9.80665;

namespace internal {

/// `value` times `factor` in the precision of `value`.
template <typename T>
[[nodiscard]] constexpr T Scaled(const T& value, double factor) {
  if constexpr (requires { typename T::Scalar; }) {
    return value * static_cast<typename T::Scalar>(factor);
  } else {
    return static_cast<T>(value * static_cast<T>(factor));
  }
}

}  // namespace internal

/// Also degrees per second to radians per second.
template <typename T>
[[nodiscard]] constexpr T RadFromDeg(const T& value_deg) {
  return internal::Scaled(value_deg, std::numbers::pi / 180.0);
}
template <typename T>
[[nodiscard]] constexpr T DegFromRad(const T& value_rad) {
  return internal::Scaled(value_rad, 180.0 / std::numbers::pi);
}

template <typename T>
[[nodiscard]] constexpr T MetresPerS2FromG(const T& value_g) {
  return internal::Scaled(value_g, kStandardGravity_m_s2);
}
template <typename T>
[[nodiscard]] constexpr T GFromMetresPerS2(const T& value_m_s2) {
  return internal::Scaled(value_m_s2, 1.0 / kStandardGravity_m_s2);
}

template <typename T>
[[nodiscard]] constexpr T TeslaFromMicrotesla(const T& value_ut) {
  return internal::Scaled(value_ut, 1e-6);
}
template <typename T>
[[nodiscard]] constexpr T MicroteslaFromTesla(const T& value_tesla) {
  return internal::Scaled(value_tesla, 1e6);
}

template <typename T>
[[nodiscard]] constexpr T TeslaFromGauss(const T& value_gauss) {
  return internal::Scaled(value_gauss, 1e-4);
}

template <typename T>
[[nodiscard]] constexpr T MetresFromMillimetres(const T& value_mm) {
  return internal::Scaled(value_mm, 1e-3);
}

}  // namespace limbcast::units
