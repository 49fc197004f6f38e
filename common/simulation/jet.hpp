#pragma once

#include <cmath>

namespace limbcast::simulation {

/// A value with its first and second derivative by time: arithmetic on jets is arithmetic on
/// functions of time, exact to rounding (forward-mode automatic differentiation).
///
///   (f∘g)' = f'(g)·g',   (f∘g)'' = f''(g)·g'² + f'(g)·g''
///
/// Griewank, Walther, "Evaluating Derivatives", 2nd ed., SIAM 2008, chapter 13 (Taylor
/// coefficients).
struct Jet {
  double value = 0.0;
  double rate = 0.0;   ///< d/dt
  double accel = 0.0;  ///< d²/dt²

  constexpr Jet() = default;
  constexpr Jet(double constant) : value(constant) {}  // NOLINT: a constant is a jet
  constexpr Jet(double value_in, double rate_in, double accel_in)
      : value(value_in), rate(rate_in), accel(accel_in) {}

  /// Time itself.
  [[nodiscard]] static constexpr Jet Variable(double t) { return {t, 1.0, 0.0}; }

  constexpr Jet operator-() const { return {-value, -rate, -accel}; }
  constexpr Jet& operator+=(const Jet& b) { return *this = *this + b; }
  constexpr Jet& operator-=(const Jet& b) { return *this = *this - b; }
  constexpr Jet& operator*=(const Jet& b) { return *this = *this * b; }

  friend constexpr Jet operator+(const Jet& a, const Jet& b) {
    return {a.value + b.value, a.rate + b.rate, a.accel + b.accel};
  }
  friend constexpr Jet operator-(const Jet& a, const Jet& b) {
    return {a.value - b.value, a.rate - b.rate, a.accel - b.accel};
  }
  friend constexpr Jet operator*(const Jet& a, const Jet& b) {
    return {a.value * b.value, a.rate * b.value + a.value * b.rate,
            a.accel * b.value + 2.0 * a.rate * b.rate + a.value * b.accel};
  }
};

/// f(g) from f's value and first two derivatives at g.value.
[[nodiscard]] constexpr Jet Chain(const Jet& g, double f, double df, double ddf) {
  return {f, df * g.rate, ddf * g.rate * g.rate + df * g.accel};
}

[[nodiscard]] inline Jet Sin(const Jet& a) {
  const double s = std::sin(a.value);
  const double c = std::cos(a.value);
  return Chain(a, s, c, -s);
}
[[nodiscard]] inline Jet Cos(const Jet& a) {
  const double s = std::sin(a.value);
  const double c = std::cos(a.value);
  return Chain(a, c, -s, -c);
}
/// a > 0.
[[nodiscard]] inline Jet Sqrt(const Jet& a) {
  const double root = std::sqrt(a.value);
  return Chain(a, root, 0.5 / root, -0.25 / (root * a.value));
}
/// a ≠ 0.
[[nodiscard]] inline Jet Inverse(const Jet& a) {
  const double r = 1.0 / a.value;
  return Chain(a, r, -r * r, 2.0 * r * r * r);
}
[[nodiscard]] inline Jet operator/(const Jet& a, const Jet& b) { return a * Inverse(b); }

/// |a| < 1.
[[nodiscard]] inline Jet Acos(const Jet& a) {
  const double w = 1.0 / std::sqrt(1.0 - a.value * a.value);
  return Chain(a, std::acos(a.value), -w, -a.value * w * w * w);
}

/// The angle of (x, y) in (−π, π]; the point is not the origin. The derivatives do not see the jump
/// at π.
[[nodiscard]] inline Jet Atan2(const Jet& y, const Jet& x) {
  // θ' = (x·y' − y·x') / r², and the same rule once more for θ''.
  const double r2 = x.value * x.value + y.value * y.value;
  const double rate = (x.value * y.rate - y.value * x.rate) / r2;
  const double r2_rate = 2.0 * (x.value * x.rate + y.value * y.rate);
  const double accel = (x.value * y.accel - y.value * x.accel - rate * r2_rate) / r2;
  return {std::atan2(y.value, x.value), rate, accel};
}

/// log(1 + exp(a)), without overflow.
[[nodiscard]] inline Jet SoftPlus(const Jet& a) {
  const double f =
      a.value > 0.0 ? a.value + std::log1p(std::exp(-a.value)) : std::log1p(std::exp(a.value));
  const double df = 1.0 / (1.0 + std::exp(-a.value));
  return Chain(a, f, df, df * (1.0 - df));
}

/// Three jets: a moving point or vector. Small on purpose; frames live in rigid_motion.hpp.
struct Jet3 {
  Jet x;
  Jet y;
  Jet z;

  friend constexpr Jet3 operator+(const Jet3& a, const Jet3& b) {
    return {a.x + b.x, a.y + b.y, a.z + b.z};
  }
  friend constexpr Jet3 operator-(const Jet3& a, const Jet3& b) {
    return {a.x - b.x, a.y - b.y, a.z - b.z};
  }
  friend constexpr Jet3 operator*(const Jet& s, const Jet3& a) {
    return {s * a.x, s * a.y, s * a.z};
  }
};

[[nodiscard]] constexpr Jet Dot(const Jet3& a, const Jet3& b) {
  return a.x * b.x + a.y * b.y + a.z * b.z;
}
[[nodiscard]] constexpr Jet3 Cross(const Jet3& a, const Jet3& b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
/// a ≠ 0.
[[nodiscard]] inline Jet3 Normalized(const Jet3& a) { return Inverse(Sqrt(Dot(a, a))) * a; }

}  // namespace limbcast::simulation
