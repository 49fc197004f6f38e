#pragma once

#include <cstddef>
#include <string_view>

#include "common/filters/bounded_motion_config.hpp"
#include "common/filters/gauss_newton_config.hpp"

namespace limbcast::filters {

/// One step of as many sensors as a vector register holds, compiled for one instruction set
/// (DESIGN-batch.md). Inputs and states are blocks (lane_block.hpp): `width` records, number by
/// number, aligned to kBlockAlignment_bytes. Lanes whose input is not `present` keep their state.
struct BatchKernels {
  std::string_view instruction_set;  ///< "baseline", "avx2"
  int width_double = 1;              ///< lanes of a block of doubles
  int width_float = 1;               ///< lanes of a block of floats

  /// GaussNewtonInput and GaussNewtonState in double and in single precision; form kReduced3x3.
  void (*gauss_newton_double)(const GaussNewtonConfig& config, const std::byte* inputs,
                              std::byte* states) = nullptr;
  void (*gauss_newton_float)(const GaussNewtonConfig& config, const std::byte* inputs,
                             std::byte* states) = nullptr;

  /// BoundedMotionInput and BoundedMotionState in double and in single precision.
  void (*bounded_motion_double)(const BoundedMotionConfig& config, const std::byte* inputs,
                                std::byte* states) = nullptr;
  void (*bounded_motion_float)(const BoundedMotionConfig& config, const std::byte* inputs,
                               std::byte* states) = nullptr;
};

inline constexpr std::size_t kBlockAlignment_bytes = 64;

/// For any machine of the build's architecture.
[[nodiscard]] const BatchKernels& BaselineKernels();
/// With AVX2; null where the machine has none, or the build is for another architecture.
[[nodiscard]] const BatchKernels* Avx2Kernels();
/// The widest that this machine runs.
[[nodiscard]] const BatchKernels& BestKernels();

}  // namespace limbcast::filters
