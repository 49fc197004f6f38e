// Packs of 32 bytes, compiled with -mavx2 (CMakeLists.txt). No other file names these packs, so no
// inline function that another file may call is compiled for AVX2 here; the test
// AvxStaysInItsFile looks at the symbols.
#include "common/filters/batch_kernels_avx2.hpp"

#include <immintrin.h>

#include "common/filters/batch_kernels_lanes.hpp"

namespace limbcast::filters {

template <>
struct lanes::Instructions<double, 32> {
  using Vector = Pack<double, 32>::Vector;
  using MaskVector = PackMask<double, 32>::Vector;
  static bool Any(MaskVector mask) { return _mm256_testz_si256(__m256i(mask), __m256i(mask)) == 0; }
  static Vector Sqrt(Vector a) { return Vector(_mm256_sqrt_pd(__m256d(a))); }
};
template <>
struct lanes::Instructions<float, 32> {
  using Vector = Pack<float, 32>::Vector;
  using MaskVector = PackMask<float, 32>::Vector;
  static bool Any(MaskVector mask) { return _mm256_testz_si256(__m256i(mask), __m256i(mask)) == 0; }
  static Vector Sqrt(Vector a) { return Vector(_mm256_sqrt_ps(__m256(a))); }
};

const BatchKernels& Avx2KernelsUnchecked() {
  static constexpr BatchKernels kKernels = MakeBatchKernels<32>("avx2");
  return kKernels;
}

}  // namespace limbcast::filters
