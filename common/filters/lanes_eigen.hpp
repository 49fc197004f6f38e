#pragma once

#include <Eigen/Core>

#include "common/filters/lanes.hpp"

/// Packs as coefficients of Eigen's matrices. Eigen sees a number type it has no packets for, and
/// writes out the operations one by one.
namespace Eigen {

template <typename S, int kBytes>
struct NumTraits<limbcast::filters::lanes::Pack<S, kBytes>> : GenericNumTraits<S> {
  using Real = limbcast::filters::lanes::Pack<S, kBytes>;
  using NonInteger = Real;
  using Nested = Real;
  using Literal = Real;
  enum { RequireInitialization = 0 };
};

}  // namespace Eigen

namespace limbcast::filters::lanes {

/// Found by Eigen's norm().
template <typename S, int kBytes>
[[nodiscard]] inline Pack<S, kBytes> sqrt(Pack<S, kBytes> a) {  // NOLINT: the name Eigen looks for
  return Sqrt(a);
}

}  // namespace limbcast::filters::lanes
