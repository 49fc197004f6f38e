// What the kernels compute is tested in filter_batches_test.cpp, against the single forms.
#include <gtest/gtest.h>

#include "common/filters/batch_kernels.hpp"

namespace limbcast::filters {
namespace {

TEST(BatchKernelsAvx2Test, HasPacksOf32Bytes) {
  const BatchKernels* const kernels = Avx2Kernels();
  if (kernels == nullptr) {
    GTEST_SKIP() << "not on this machine";
  }
  EXPECT_EQ(kernels->instruction_set, "avx2");
  EXPECT_EQ(kernels->width_double, 4);
  EXPECT_EQ(kernels->width_float, 8);
}

}  // namespace
}  // namespace limbcast::filters
