#pragma once

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <limits>
#include <type_traits>

/// Numbers that stand for several sensors at once (DESIGN-batch.md). An algorithm written once over
/// a type `T` runs for one sensor with T = double or float, and for kLanes sensors with T = a Pack:
/// what a branch decides for one sensor, `Select` decides lane by lane.
///
/// Each operation of a Pack is the same IEEE operation on each lane, so a lane gets bit for bit
/// what the scalar form computes, as long as the compiler contracts no products (CMakeLists.txt
/// says -ffp-contract=off) and the algorithm spells out its order of additions.
///
/// A Pack is as wide as one vector register of one instruction set. Its width is part of its type,
/// and only the source file compiled for that instruction set may name it: no inline function of
/// two instruction sets then shares a symbol.
namespace limbcast::filters::lanes {

/// All bits of a lane set, or none: what a comparison of packs gives.
template <typename S, int kBytes>
struct PackMask {
  using Int = std::conditional_t<sizeof(S) == 8, std::int64_t, std::int32_t>;
  using Vector [[gnu::vector_size(kBytes)]] = Int;
  Vector v;

  PackMask() = default;
  explicit PackMask(Vector vector) : v(vector) {}
  explicit PackMask(bool all) : v(Vector{} - static_cast<Int>(all ? 1 : 0)) {}
  friend PackMask operator&(PackMask a, PackMask b) { return PackMask(a.v & b.v); }
  friend PackMask operator|(PackMask a, PackMask b) { return PackMask(a.v | b.v); }
  friend PackMask operator!(PackMask a) { return PackMask(~a.v); }
};

/// kBytes / sizeof(S) numbers in one register.
template <typename S, int kBytes>
struct Pack {
  using Number = S;
  using Mask = PackMask<S, kBytes>;
  using Vector [[gnu::vector_size(kBytes)]] = S;
  static constexpr int kLanes = kBytes / static_cast<int>(sizeof(S));
  Vector v;

  Pack() = default;
  explicit Pack(Vector vector) : v(vector) {}
  /// The same number in every lane.
  template <typename Arithmetic, typename = std::enable_if_t<std::is_arithmetic_v<Arithmetic>>>
  Pack(Arithmetic number)  // NOLINT: numbers in formulas are numbers for all lanes
      : v(Vector{} + static_cast<S>(number)) {}

  Pack& operator+=(Pack o) { return v += o.v, *this; }
  Pack& operator-=(Pack o) { return v -= o.v, *this; }
  Pack& operator*=(Pack o) { return v *= o.v, *this; }
  Pack& operator/=(Pack o) { return v /= o.v, *this; }
  friend Pack operator+(Pack a, Pack b) { return Pack(a.v + b.v); }
  friend Pack operator-(Pack a, Pack b) { return Pack(a.v - b.v); }
  friend Pack operator*(Pack a, Pack b) { return Pack(a.v * b.v); }
  friend Pack operator/(Pack a, Pack b) { return Pack(a.v / b.v); }
  friend Pack operator-(Pack a) { return Pack(-a.v); }
  friend Mask operator<(Pack a, Pack b) { return Mask(a.v < b.v); }
  friend Mask operator>(Pack a, Pack b) { return Mask(a.v > b.v); }
  friend Mask operator<=(Pack a, Pack b) { return Mask(a.v <= b.v); }
  friend Mask operator>=(Pack a, Pack b) { return Mask(a.v >= b.v); }
  friend Mask operator==(Pack a, Pack b) { return Mask(a.v == b.v); }
};

template <typename T>
struct Traits {
  using Number = T;
  using Mask = bool;
  static constexpr int kLanes = 1;
};
template <typename S, int kBytes>
struct Traits<Pack<S, kBytes>> {
  using Number = S;
  using Mask = PackMask<S, kBytes>;
  static constexpr int kLanes = Pack<S, kBytes>::kLanes;
};
/// double or float, for T and for packs of them.
template <typename T>
using NumberOf = typename Traits<T>::Number;
/// bool, or one for each lane.
template <typename T>
using MaskOf = typename Traits<T>::Mask;

/// `a` where the mask is set, `b` elsewhere. Both are computed: a value that is not chosen may be
/// NaN.
template <typename T, typename = std::enable_if_t<std::is_floating_point_v<T>>>
[[nodiscard]] constexpr T Select(bool mask, T a, std::type_identity_t<T> b) {
  return mask ? a : b;
}
template <typename S, int kBytes>
[[nodiscard]] inline Pack<S, kBytes> Select(PackMask<S, kBytes> mask, Pack<S, kBytes> a,
                                            std::type_identity_t<Pack<S, kBytes>> b) {
  return Pack<S, kBytes>(mask.v ? a.v : b.v);
}

/// What an instruction set does in one instruction and the language has no operator for. Here lane
/// by lane; the source file of an instruction set specialises it for its packs.
template <typename S, int kBytes>
struct Instructions {
  using Vector = typename Pack<S, kBytes>::Vector;
  using MaskVector = typename PackMask<S, kBytes>::Vector;
  static constexpr int kLanes = Pack<S, kBytes>::kLanes;

  static bool Any(MaskVector mask) {
    typename PackMask<S, kBytes>::Int any = 0;
    for (int i = 0; i < kLanes; ++i) {
      any |= mask[i];
    }
    return any != 0;
  }
  static Vector Sqrt(Vector a) {
    for (int i = 0; i < kLanes; ++i) {
      a[i] = std::sqrt(a[i]);
    }
    return a;
  }
};

/// At least one lane, every lane.
[[nodiscard]] constexpr bool Any(bool mask) { return mask; }
[[nodiscard]] constexpr bool All(bool mask) { return mask; }
template <typename S, int kBytes>
[[nodiscard]] inline bool Any(PackMask<S, kBytes> mask) {
  return Instructions<S, kBytes>::Any(mask.v);
}
template <typename S, int kBytes>
[[nodiscard]] inline bool All(PackMask<S, kBytes> mask) {
  return !Any(!mask);
}

/// a and b, lane by lane.
[[nodiscard]] constexpr bool Both(bool a, bool b) { return a && b; }
template <typename S, int kBytes>
[[nodiscard]] inline PackMask<S, kBytes> Both(PackMask<S, kBytes> a, PackMask<S, kBytes> b) {
  return a & b;
}

/// A truth value as a number, for states and inputs that consist of nothing but numbers.
template <typename T>
[[nodiscard]] inline MaskOf<T> IsSet(T flag) {
  return flag > T(0);
}
template <typename T>
[[nodiscard]] inline T Flag(MaskOf<T> mask) {
  return Select(mask, T(1), T(0));
}

/// `before` in the lanes where the mask is not set, for records of nothing but T.
template <typename T, typename Record>
inline void KeepWhereNot(MaskOf<T> mask, const Record& before, Record& after) {
  static_assert(sizeof(Record) % sizeof(T) == 0);
  const auto* from = reinterpret_cast<const T*>(&before);
  auto* to = reinterpret_cast<T*>(&after);
  for (std::size_t i = 0; i < sizeof(Record) / sizeof(T); ++i) {
    to[i] = Select(mask, to[i], from[i]);
  }
}

/// `f` of each lane's number. For what has no instruction: the same library function for all forms.
template <typename T, typename F>
[[nodiscard]] inline T Map(T a, F f) {
  if constexpr (std::is_floating_point_v<T>) {
    return f(a);
  } else {
    for (int i = 0; i < T::kLanes; ++i) {
      a.v[i] = f(a.v[i]);
    }
    return a;
  }
}

template <typename T>
[[nodiscard]] inline T Sqrt(T a) {
  if constexpr (std::is_floating_point_v<T>) {
    return std::sqrt(a);
  } else {
    return T(
        Instructions<NumberOf<T>, T::kLanes* static_cast<int>(sizeof(NumberOf<T>))>::Sqrt(a.v));
  }
}

/// As std::min and std::max order them: `a` when neither is less.
template <typename T>
[[nodiscard]] inline T Min(T a, std::type_identity_t<T> b) {
  return Select(b < a, b, a);
}
template <typename T>
[[nodiscard]] inline T Max(T a, std::type_identity_t<T> b) {
  return Select(a < b, b, a);
}
}  // namespace limbcast::filters::lanes
