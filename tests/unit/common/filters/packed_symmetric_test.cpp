#include "common/filters/packed_symmetric.hpp"

#include <gtest/gtest.h>

#include <algorithm>

namespace limbcast::filters {
namespace {

constexpr int kDim = 5;
using Full = Eigen::Matrix<double, kDim, kDim>;
using Packed = PackedSymmetric<double, kDim>;

Full Numbered() {
  Full full;
  for (int row = 0; row < kDim; ++row) {
    for (int column = 0; column < kDim; ++column) {
      full(row, column) = 1.0 + 10.0 * std::min(row, column) + std::max(row, column);
    }
  }
  return full;
}

TEST(PackedSymmetricTest, ComesBackAsItWas) {
  Packed packed;
  packed.FromFull(Numbered());
  EXPECT_EQ(packed.Full(), Numbered());
  static_assert(sizeof(Packed) == 15 * sizeof(double));
}

TEST(PackedSymmetricTest, BothHalvesAreTheSameNumber) {
  Packed packed;
  packed.FromFull(Numbered());
  for (int row = 0; row < kDim; ++row) {
    for (int column = 0; column < kDim; ++column) {
      EXPECT_EQ(packed(row, column), Numbered()(row, column)) << row << ' ' << column;
      EXPECT_EQ(&packed(row, column), &packed(column, row)) << row << ' ' << column;
    }
  }
  EXPECT_EQ(&packed(2, 2), &packed.upper[5]) << "three columns are six numbers";
}

TEST(PackedSymmetricTest, TakesTheMeanOfHalvesThatDiffer) {
  Full full = Numbered();
  full(1, 3) += 0.5;
  Packed packed;
  packed.FromFull(full);
  EXPECT_EQ(packed(3, 1), Numbered()(3, 1) + 0.25);
  packed.SetZero();
  EXPECT_EQ(packed.Full(), Full::Zero());
}

TEST(PackedSymmetricTest, FillsACornerOfALargerMatrix) {
  Packed packed;
  packed.FromFull(Numbered());
  Eigen::Matrix<double, kDim + 1, kDim> padded;
  padded.setConstant(-1.0);
  packed.ToFull(padded);
  EXPECT_EQ(padded.topRows<kDim>(), Numbered());
  EXPECT_EQ(padded.bottomRows<1>().maxCoeff(), -1.0);
}

}  // namespace
}  // namespace limbcast::filters
