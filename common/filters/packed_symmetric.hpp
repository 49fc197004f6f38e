#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <cstddef>

namespace limbcast::filters {

/// A symmetric matrix of kDim rows as its upper triangle, column after column: half the memory of
/// the matrix. Nothing but Scalar; the first three columns are the first six numbers.
template <typename Scalar, int kDim>
struct PackedSymmetric {
  static constexpr int kNumbers = kDim * (kDim + 1) / 2;

  std::array<Scalar, static_cast<std::size_t>(kNumbers)> upper;

  [[nodiscard]] Scalar& operator()(int row, int column) { return upper[Index(row, column)]; }
  [[nodiscard]] const Scalar& operator()(int row, int column) const {
    return upper[Index(row, column)];
  }
  void SetZero() { upper.fill(Scalar(0)); }

  /// Into the first kDim rows and columns of `full`.
  template <typename Full>
  void ToFull(Full& full) const {
    std::size_t i = 0;
    for (int column = 0; column < kDim; ++column) {
      for (int row = 0; row <= column; ++row, ++i) {
        full(row, column) = upper[i];
        full(column, row) = upper[i];
      }
    }
  }
  /// The mean of both halves of `full`, which are alike but for rounding.
  template <typename Full>
  void FromFull(const Full& full) {
    std::size_t i = 0;
    for (int column = 0; column < kDim; ++column) {
      for (int row = 0; row < column; ++row, ++i) {
        upper[i] = Scalar(0.5) * (full(row, column) + full(column, row));
      }
      upper[i++] = full(column, column);
    }
  }
  [[nodiscard]] Eigen::Matrix<Scalar, kDim, kDim> Full() const {
    Eigen::Matrix<Scalar, kDim, kDim> full;
    ToFull(full);
    return full;
  }

 private:
  [[nodiscard]] static std::size_t Index(int row, int column) {
    const auto upper_row = static_cast<std::size_t>(std::min(row, column));
    const auto upper_column = static_cast<std::size_t>(std::max(row, column));
    return upper_column * (upper_column + 1) / 2 + upper_row;
  }
};

}  // namespace limbcast::filters
