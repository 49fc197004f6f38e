#include "common/filters/batch_kernels.hpp"

#include <gtest/gtest.h>

namespace limbcast::filters {
namespace {

TEST(BatchKernelsTest, TheBestAreAvx2WhereTheMachineHasIt) {
  const BatchKernels* const avx2 = Avx2Kernels();
  EXPECT_EQ(&BestKernels(), avx2 != nullptr ? avx2 : &BaselineKernels());
}

}  // namespace
}  // namespace limbcast::filters
