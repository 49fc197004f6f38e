// Packs of 16 bytes: one register of the smallest x86-64 and of 64-bit ARM; elsewhere the compiler
// makes single operations of them.
#include "common/filters/batch_kernels_lanes.hpp"

namespace limbcast::filters {

const BatchKernels& BaselineKernels() {
  static constexpr BatchKernels kKernels = MakeBatchKernels<16>("baseline");
  return kKernels;
}

}  // namespace limbcast::filters
