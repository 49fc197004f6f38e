// What the kernels compute is tested in filter_batches_test.cpp, against the single forms.
#include <gtest/gtest.h>

#include "common/filters/batch_kernels.hpp"

namespace limbcast::filters {
namespace {

TEST(BatchKernelsBaselineTest, HasPacksOf16Bytes) {
  const BatchKernels* const kernels = &BaselineKernels();
  if (kernels == nullptr) {
    GTEST_SKIP() << "not on this machine";
  }
  EXPECT_EQ(kernels->instruction_set, "baseline");
  EXPECT_EQ(kernels->width_double, 2);
  EXPECT_EQ(kernels->width_float, 4);
}

}  // namespace
}  // namespace limbcast::filters
