#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <vector>

#include "common/base/expects.hpp"
#include "common/filters/position/backward_pass.hpp"

namespace limbcast::filters {

/// The newest epochs of a filter, for fixed-lag smoothing (design/position.md section 5): on every
/// new epoch the backward pass runs from the newest to the lagged one. Of each epoch it keeps the
/// record and `rows` = C P⁺, the covariance of C outputs with the error state. Ring of fixed size:
/// allocates at construction only. Thread-compatible.
template <int N, int M, int Z, int C>
class LagWindow {
 public:
  using Record = BackwardRecord<N, M, Z>;
  using Rows = Eigen::Matrix<double, C, N>;

  /// @param capacity  epochs kept, ≥ 1.
  explicit LagWindow(std::size_t capacity) : records_(capacity), rows_(capacity) {
    Expects(capacity >= 1, "room for an epoch");
  }

  void Clear() { size_ = 0; }
  /// Takes the next epoch; the oldest falls out when full.
  void Push(const Record& record, const Rows& rows) {
    newest_ = (newest_ + 1) % capacity();
    size_ = size_ < capacity() ? size_ + 1 : size_;
    records_[newest_] = record;
    rows_[newest_] = rows;
  }

  [[nodiscard]] std::size_t size() const { return size_; }
  [[nodiscard]] std::size_t capacity() const { return records_.size(); }
  /// The epoch `back` places before the newest; 0 ≤ back < size().
  [[nodiscard]] const Record& record(std::size_t back) const { return records_[Place(back)]; }

  /// What the epochs after it say of the outputs of the one `back` places before the newest.
  [[nodiscard]] Eigen::Matrix<double, C, 1> Correction(std::size_t back) const {
    Eigen::Matrix<double, N, 1> lambda = Eigen::Matrix<double, N, 1>::Zero();
    for (std::size_t i = 0; i < back; ++i) {
      StepBack(record(i), lambda);
    }
    return rows_[Place(back)] * lambda;
  }

  /// What the epochs after it leave of `cov`, the covariance of its first K outputs.
  template <int K>
  [[nodiscard]] Eigen::Matrix<double, K, K> Covariance(std::size_t back,
                                                       Eigen::Matrix<double, K, K> cov) const {
    Eigen::Matrix<double, K, N> W = rows_[Place(back)].template topRows<K>();
    for (std::size_t i = back; i-- > 0;) {
      if (record(i).chain_begins) {
        break;
      }
      StepForward(record(i), W, cov);
    }
    return cov;
  }

 private:
  [[nodiscard]] std::size_t Place(std::size_t back) const {
    return (newest_ + capacity() - back) % capacity();
  }

  // Apart, because every step of a backward pass needs a record and only its end the rows.
  std::vector<Record> records_;
  std::vector<Rows> rows_;
  std::size_t newest_ = 0;
  std::size_t size_ = 0;
};

}  // namespace limbcast::filters
