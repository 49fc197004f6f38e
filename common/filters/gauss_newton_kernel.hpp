#pragma once

#include <cmath>

namespace limbcast::filters::kernel {

/// The arithmetic of one Gauss–Newton tracker step on plain numbers. Eigen's packets cost more than
/// they gain on single quaternions (components are stored one by one and loaded in pairs), and a
/// loop over these functions vectorises over sensors. `T` is double or float.

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

/// q ⊗ (1, v).
template <typename T>
[[nodiscard]] inline Quaternion<T> TimesOnePlus(const Quaternion<T>& q, const Vector<T>& v) {
  return {q.w - q.x * v.x - q.y * v.y - q.z * v.z, q.x + q.w * v.x + q.y * v.z - q.z * v.y,
          q.y + q.w * v.y + q.z * v.x - q.x * v.z, q.z + q.w * v.z + q.x * v.y - q.y * v.x};
}

/// Two Newton steps for 1/|q|: exact to rounding while | |q|² − 1 | < 1e-3.
template <typename T>
[[nodiscard]] inline Quaternion<T> NormalisedNearOne(const Quaternion<T>& q) {
  const T norm2 = q.w * q.w + q.x * q.x + q.y * q.y + q.z * q.z;
  const T once = T(1.5) - T(0.5) * norm2;
  const T s = once * (T(1.5) - T(0.5) * norm2 * once * once);
  return {q.w * s, q.x * s, q.y * s, q.z * s};
}

/// Rows of R(q): the earth axes in sensor coordinates.
template <typename T>
[[nodiscard]] inline Vector<T> EastInSensor(const Quaternion<T>& q) {
  return {T(1) - T(2) * (q.y * q.y + q.z * q.z), T(2) * (q.x * q.y - q.w * q.z),
          T(2) * (q.x * q.z + q.w * q.y)};
}
template <typename T>
[[nodiscard]] inline Vector<T> NorthInSensor(const Quaternion<T>& q) {
  return {T(2) * (q.x * q.y + q.w * q.z), T(1) - T(2) * (q.x * q.x + q.z * q.z),
          T(2) * (q.y * q.z - q.w * q.x)};
}
template <typename T>
[[nodiscard]] inline Vector<T> UpInSensor(const Quaternion<T>& q) {
  return {T(2) * (q.x * q.z - q.w * q.y), T(2) * (q.y * q.z + q.w * q.x),
          T(1) - T(2) * (q.x * q.x + q.y * q.y)};
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

/// Δv of the reduced step, see ReducedStep; ρ² instead of ρ.
template <typename T>
[[nodiscard]] inline Vector<T> ReducedStep(const Vector<T>& h, const Vector<T>& b,
                                           const Vector<T>& h0, const Vector<T>& b0, T rho2) {
  constexpr T kSingularBelow = T(1e-6);
  constexpr T kLambda = T(1e-3);
  const Vector<T> hxb = Cross(h, b);
  // det A = (1+ρ²)·ρ²·|h × b|² for unit vectors.
  const T det = (T(1) + rho2) * rho2 * Dot(hxb, hxb);
  const T s = T(1) + rho2 + (det < kSingularBelow ? kLambda : T(0));
  const Vector<T> rb = Scaled(b, rho2);
  const Vector<T> ch = Cross(h0, h);
  const Vector<T> cb = Cross(b0, b);
  const Vector<T> c{T(0.5) * (ch.x + rho2 * cb.x), T(0.5) * (ch.y + rho2 * cb.y),
                    T(0.5) * (ch.z + rho2 * cb.z)};
  return SolveSymmetric(s - h.x * h.x - rb.x * b.x, -h.x * h.y - rb.x * b.y,
                        -h.x * h.z - rb.x * b.z, s - h.y * h.y - rb.y * b.y,
                        -h.y * h.z - rb.y * b.z, s - h.z * h.z - rb.z * b.z, c);
}

}  // namespace limbcast::filters::kernel
