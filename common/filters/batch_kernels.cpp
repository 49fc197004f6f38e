#include "common/filters/batch_kernels.hpp"

#include "common/filters/batch_kernels_avx2.hpp"

namespace limbcast::filters {

const BatchKernels* Avx2Kernels() {
#if defined(__x86_64__)  // the build has batch_kernels_avx2.cpp there only
  return __builtin_cpu_supports("avx2") != 0 ? &Avx2KernelsUnchecked() : nullptr;
#else
  return nullptr;
#endif
}

const BatchKernels& BestKernels() {
  const BatchKernels* const avx2 = Avx2Kernels();
  return avx2 != nullptr ? *avx2 : BaselineKernels();
}

}  // namespace limbcast::filters
