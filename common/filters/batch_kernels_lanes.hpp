#pragma once

// What batch_kernels_<instruction set>.cpp instantiate; nobody else includes it.

#include "common/filters/batch_kernels.hpp"
#include "common/filters/lanes_eigen.hpp"

#include "common/filters/bounded_motion_corrections.hpp"
#include "common/filters/bounded_motion_motion.hpp"
#include "common/filters/gauss_newton_core.hpp"

namespace limbcast::filters {

/// BatchKernels::gauss_newton for packs T.
template <typename T>
void GaussNewtonLanes(const GaussNewtonConfig& config, const std::byte* inputs, std::byte* states) {
  const auto& in = *reinterpret_cast<const GaussNewtonInput<T>*>(inputs);
  auto& s = *reinterpret_cast<GaussNewtonState<T>*>(states);
  const auto correct = [&s](const kernel::Quaternion<T>& q, const kernel::Vector<T>& h0,
                            const kernel::Vector<T>& b0, T rho2,
                            T gain) { return gauss_newton::Corrected(s, q, h0, b0, rho2, gain); };
  const auto present = lanes::IsSet(in.present);
  if (lanes::All(present)) {
    gauss_newton::Step(config, in, s, correct);
  } else {
    const GaussNewtonState<T> before = s;
    gauss_newton::Step(config, in, s, correct);
    lanes::KeepWhereNot<T>(present, before, s);
  }
}

/// BatchKernels::bounded_motion_... for packs T.
template <typename T>
void BoundedMotionLanes(const BoundedMotionConfig& config, const std::byte* inputs,
                        std::byte* states) {
  static_assert(sizeof(BoundedMotionState<T>) % sizeof(T) == 0);
  const auto& in = *reinterpret_cast<const BoundedMotionInput<T>*>(inputs);
  auto& state = *reinterpret_cast<BoundedMotionState<T>*>(states);
  BoundedMotionStep<T>(config, state).Update(in);
}

/// The kernels for packs of kBytes.
template <int kBytes>
constexpr BatchKernels MakeBatchKernels(std::string_view instruction_set) {
  using Double = lanes::Pack<double, kBytes>;
  using Float = lanes::Pack<float, kBytes>;
  return {.instruction_set = instruction_set,
          .width_double = Double::kLanes,
          .width_float = Float::kLanes,
          .gauss_newton_double = &GaussNewtonLanes<Double>,
          .gauss_newton_float = &GaussNewtonLanes<Float>,
          .bounded_motion_double = &BoundedMotionLanes<Double>,
          .bounded_motion_float = &BoundedMotionLanes<Float>};
}

}  // namespace limbcast::filters
