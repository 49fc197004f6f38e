#pragma once

#include "common/filters/batch_kernels.hpp"

namespace limbcast::filters {

/// The kernels themselves, on whatever machine. For Avx2Kernels.
[[nodiscard]] const BatchKernels& Avx2KernelsUnchecked();

}  // namespace limbcast::filters
