#pragma once

#include <cmath>

#include "common/filters/lanes.hpp"

namespace limbcast::filters::kernel {

/// The arithmetic of one Gauss–Newton tracker step on plain numbers. Eigen's packets cost more than
/// they gain on single quaternions (components are stored one by one and loaded in pairs), and
/// these functions vectorise over sensors. `T` is double, float, or a pack of them (lanes.hpp).
///
/// A step is as long as its chain of dependent operations from one attitude to the next: sums of
/// four are added in pairs, and what does not depend on the attitude is worked out beside it.

template <typename T>
struct Vector {
  T x, y, z;
};
template <typename T>
struct Quaternion {
  T w, x, y, z;
};

template <typename T>
[[nodiscard]] inline Vector<T> Cross(const Vector<T>& a, const Vector<T>& b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
template <typename T>
[[nodiscard]] inline T Dot(const Vector<T>& a, const Vector<T>& b) {
  return a.x * b.x + a.y * b.y + a.z * b.z;
}
template <typename T>
[[nodiscard]] inline Vector<T> Scaled(const Vector<T>& a, T s) {
  return {a.x * s, a.y * s, a.z * s};
}
template <typename T>
[[nodiscard]] inline Vector<T> operator-(const Vector<T>& a, const Vector<T>& b) {
  return {a.x - b.x, a.y - b.y, a.z - b.z};
}
template <typename T>
[[nodiscard]] inline Vector<T> operator+(const Vector<T>& a, const Vector<T>& b) {
  return {a.x + b.x, a.y + b.y, a.z + b.z};
}
template <typename T>
[[nodiscard]] inline Vector<T> Select(lanes::MaskOf<T> mask, const Vector<T>& a,
                                      const Vector<T>& b) {
  return {lanes::Select(mask, a.x, b.x), lanes::Select(mask, a.y, b.y),
          lanes::Select(mask, a.z, b.z)};
}
template <typename T>
[[nodiscard]] inline Quaternion<T> Select(lanes::MaskOf<T> mask, const Quaternion<T>& a,
                                          const Quaternion<T>& b) {
  return {lanes::Select(mask, a.w, b.w), lanes::Select(mask, a.x, b.x),
          lanes::Select(mask, a.y, b.y), lanes::Select(mask, a.z, b.z)};
}

/// q ⊗ (1, v).
template <typename T>
[[nodiscard]] inline Quaternion<T> TimesOnePlus(const Quaternion<T>& q, const Vector<T>& v) {
  return {(q.w - q.x * v.x) - (q.y * v.y + q.z * v.z), (q.x + q.w * v.x) + (q.y * v.z - q.z * v.y),
          (q.y + q.w * v.y) + (q.z * v.x - q.x * v.z), (q.z + q.w * v.z) + (q.x * v.y - q.y * v.x)};
}

/// (1, v) ⊗ q.
template <typename T>
[[nodiscard]] inline Quaternion<T> OnePlusTimes(const Vector<T>& v, const Quaternion<T>& q) {
  return {(q.w - v.x * q.x) - (v.y * q.y + v.z * q.z), (q.x + v.x * q.w) + (v.y * q.z - v.z * q.y),
          (q.y + v.y * q.w) + (v.z * q.x - v.x * q.z), (q.z + v.z * q.w) + (v.x * q.y - v.y * q.x)};
}

/// |q|².
template <typename T>
[[nodiscard]] inline T SquaredNorm(const Quaternion<T>& q) {
  return (q.w * q.w + q.x * q.x) + (q.y * q.y + q.z * q.z);
}
template <typename T>
[[nodiscard]] inline Quaternion<T> Scaled(const Quaternion<T>& q, T s) {
  return {q.w * s, q.x * s, q.y * s, q.z * s};
}

/// 1/√(1+e). Close to 0, where trackers stay, its series to e⁴: exact to rounding while |e| < 1e-3.
template <typename T>
[[nodiscard]] inline T InverseRootOfOnePlus(T e) {
  constexpr double kSeriesWithin = 1e-3;
  const T e2 = e * e;
  T s = (T(1) - T(0.5) * e) + e2 * ((T(0.375) - T(0.3125) * e) + e2 * T(0.2734375));
  const lanes::MaskOf<T> far(!(e2 < T(kSeriesWithin * kSeriesWithin)));
  if (lanes::Any(far)) {
    s = lanes::Select(far, T(T(1) / lanes::Sqrt(T(T(1) + e))), s);
  }
  return s;
}

/// q/|q|.
template <typename T>
[[nodiscard]] inline Quaternion<T> Normalised(const Quaternion<T>& q) {
  return Scaled(q, InverseRootOfOnePlus(T(SquaredNorm(q) - T(1))));
}

/// (1, v) ⊗ q, normalised, without waiting for the product: its norm is √(1 + |v|²)·|q|, and both
/// factors are known before.
template <typename T>
[[nodiscard]] inline Quaternion<T> NormalisedOnePlusTimes(const Vector<T>& v,
                                                          const Quaternion<T>& q) {
  constexpr double kTiny = 1e-8;  // 3/8 of its square is below rounding
  const T by_q = InverseRootOfOnePlus(T(SquaredNorm(q) - T(1)));
  const T v2 = Dot(v, v);
  const lanes::MaskOf<T> tiny(v2 < T(kTiny));
  T by_v = T(1) - T(0.5) * v2;
  if (!lanes::All(tiny)) {
    by_v = lanes::Select(tiny, by_v, InverseRootOfOnePlus(v2));
  }
  return Scaled(OnePlusTimes(v, q), T(by_v * by_q));
}

/// q ⊗ Exp(φ): sine and cosine of the half angle as series in its square x to x⁴, exact to rounding
/// below 0.25 rad (1 rad in single precision); the library's functions above.
template <typename T>
[[nodiscard]] inline Quaternion<T> Rotated(const Quaternion<T>& q, const Vector<T>& phi_rad) {
  constexpr double kSeriesBelow_rad = sizeof(lanes::NumberOf<T>) == sizeof(double) ? 0.25 : 1.0;
  const T theta2 = Dot(phi_rad, phi_rad);
  const T x = T(0.25) * theta2;
  T c = T(1) - x * (T(1.0 / 2) - x * (T(1.0 / 24) - x * (T(1.0 / 720) - x * T(1.0 / 40320))));
  T s = T(0.5) *
        (T(1) - x * (T(1.0 / 6) - x * (T(1.0 / 120) - x * (T(1.0 / 5040) - x * T(1.0 / 362880)))));
  const auto large = theta2 > T(kSeriesBelow_rad * kSeriesBelow_rad);
  if (lanes::Any(large)) {
    const T theta = lanes::Sqrt(theta2);
    const T half = T(0.5) * theta;
    const T sine = lanes::Map(half, [](auto a) { return std::sin(a); });
    c = lanes::Select(large, lanes::Map(half, [](auto a) { return std::cos(a); }), c);
    s = lanes::Select(large, T(sine / theta), s);
  }
  const Vector<T> v = Scaled(phi_rad, s);
  return {(q.w * c - q.x * v.x) - (q.y * v.y + q.z * v.z),
          (q.w * v.x + q.x * c) + (q.y * v.z - q.z * v.y),
          (q.w * v.y + q.y * c) + (q.z * v.x - q.x * v.z),
          (q.w * v.z + q.z * c) + (q.x * v.y - q.y * v.x)};
}

/// Rows of R(q): the earth axes in sensor coordinates. Written with 2x, 2y, 2z, which they share.
template <typename T>
[[nodiscard]] inline Vector<T> EastInSensor(const Quaternion<T>& q) {
  const T y2 = q.y + q.y;
  const T z2 = q.z + q.z;
  return {T(1) - (q.y * y2 + q.z * z2), q.x * y2 - q.w * z2, q.x * z2 + q.w * y2};
}
template <typename T>
[[nodiscard]] inline Vector<T> NorthInSensor(const Quaternion<T>& q) {
  const T x2 = q.x + q.x;
  const T y2 = q.y + q.y;
  const T z2 = q.z + q.z;
  return {q.x * y2 + q.w * z2, T(1) - (q.x * x2 + q.z * z2), q.y * z2 - q.w * x2};
}
template <typename T>
[[nodiscard]] inline Vector<T> UpInSensor(const Quaternion<T>& q) {
  const T x2 = q.x + q.x;
  const T y2 = q.y + q.y;
  const T z2 = q.z + q.z;
  return {q.x * z2 - q.w * y2, q.y * z2 + q.w * x2, T(1) - (q.x * x2 + q.y * y2)};
}

/// A⁻¹ c for symmetric A = [a b d; b e f; d f g], by cofactors.
template <typename T>
[[nodiscard]] inline Vector<T> SolveSymmetric(T a, T b, T d, T e, T f, T g, const Vector<T>& c) {
  const T c00 = e * g - f * f;
  const T c01 = d * f - b * g;
  const T c02 = b * f - d * e;
  const T c11 = a * g - d * d;
  const T c12 = b * d - a * f;
  const T c22 = a * e - b * b;
  const T inverse_det = T(1) / (a * c00 + b * c01 + d * c02);
  return {inverse_det * (c00 * c.x + c01 * c.y + c02 * c.z),
          inverse_det * (c01 * c.x + c11 * c.y + c12 * c.z),
          inverse_det * (c02 * c.x + c12 * c.y + c22 * c.z)};
}

inline constexpr double kSingularBelow = 1e-6;  // det A of the reduced step
inline constexpr double kLambda = 1e-3;         // added to its diagonal then

/// Δv of the reduced step, see ReducedStep; ρ² instead of ρ.
template <typename T>
[[nodiscard]] inline Vector<T> ReducedStep(const Vector<T>& h, const Vector<T>& b,
                                           const Vector<T>& h0, const Vector<T>& b0, T rho2) {
  const Vector<T> hxb = Cross(h, b);
  // det A = (1+ρ²)·ρ²·|h × b|² for unit vectors.
  const T det = (T(1) + rho2) * rho2 * Dot(hxb, hxb);
  const T s = T(1) + rho2 + lanes::Select(det < T(kSingularBelow), T(kLambda), T(0));
  const Vector<T> rb = Scaled(b, rho2);
  const Vector<T> ch = Cross(h0, h);
  const Vector<T> cb = Cross(b0, b);
  const Vector<T> c{T(0.5) * (ch.x + rho2 * cb.x), T(0.5) * (ch.y + rho2 * cb.y),
                    T(0.5) * (ch.z + rho2 * cb.z)};
  return SolveSymmetric(s - h.x * h.x - rb.x * b.x, -h.x * h.y - rb.x * b.y,
                        -h.x * h.z - rb.x * b.z, s - h.y * h.y - rb.y * b.y,
                        -h.y * h.z - rb.y * b.z, s - h.z * h.z - rb.z * b.z, c);
}

/// The same step in earth axes, R Δv: there A does not depend on the attitude, and the chain of
/// operations from one attitude to the next holds no matrix inversion. With h and b turned into
/// earth they are up and the reference n = (0, N, U), so
///
///   R A Rᵀ = s I − z zᵀ − ρ² n nᵀ,  s = 1 + ρ² (+ λ),   det = (1 + ρ²) ρ² N²
///   R c    = h₀ × z + ρ² b₀ × n     with h₀, b₀ in earth
///
/// which is s for east and a symmetric 2×2 block for north and up. Without λ that is solved by
///
///   R Δv = ½ ((h₀.n + ρ² (b₀.n U − b₀.u N)) / (1 + ρ²),  −h₀.e,  (b₀.e − U h₀.e) / N)
///
/// As it is linear in h₀ and b₀, it is taken as products of the rows of R with four vectors in
/// sensor axes that do not depend on the attitude:
///
///   R Δv = (north·a − up·b,  east·c,  east·d)
template <typename T>
struct EarthStep {
  Vector<T> a, b, c, d;

  /// @param east_S, north_S, up_S  rows of R(q).
  [[nodiscard]] Vector<T> At(const Vector<T>& east_S, const Vector<T>& north_S,
                             const Vector<T>& up_S) const {
    return {Dot(north_S, a) - Dot(up_S, b), Dot(east_S, c), Dot(east_S, d)};
  }
};

/// `gain` times the step.
///
/// @param h0, b0  measured up and field, in S, unit; b0 is zero where rho2 is.
template <typename T>
[[nodiscard]] inline EarthStep<T> MakeEarthStep(T field_north, T field_up, const Vector<T>& h0,
                                                const Vector<T>& b0, T rho2, T gain) {
  const T one = T(1) + rho2;
  const T inverse = T(0.5) * gain / (one * field_north);
  // Δv = (k c_east, hy h₀.e + by b₀.e, hz h₀.e + bz b₀.e)
  T k = inverse * field_north;
  T hy = T(-0.5) * gain;
  T by = T(0);
  T bz = inverse * one;
  T hz = -(bz * field_up);

  const T rn = rho2 * field_north;
  const lanes::MaskOf<T> singular(one * rn * field_north < T(kSingularBelow));
  if (lanes::Any(singular)) {
    const T s = one + T(kLambda);
    const T north = s - rn * field_north;
    const T cross = rn * field_up;
    const T up = s - T(1) - rho2 * field_up * field_up;
    const T by_block = T(0.5) * gain / (north * up - cross * cross);
    const T ru = rho2 * field_up;
    k = lanes::Select(singular, T(T(0.5) * gain / s), k);
    hy = lanes::Select(singular, T(-(by_block * up)), hy);
    by = lanes::Select(singular, T(by_block * (cross * rn - up * ru)), by);
    hz = lanes::Select(singular, T(-(by_block * cross)), hz);
    bz = lanes::Select(singular, T(by_block * (north * rn - cross * ru)), bz);
  }
  const T kn = k * rn;
  const T ku = k * (rho2 * field_up);
  return {Scaled(h0, k) + Scaled(b0, ku), Scaled(b0, kn), Scaled(h0, hy) + Scaled(b0, by),
          Scaled(h0, hz) + Scaled(b0, bz)};
}

}  // namespace limbcast::filters::kernel
