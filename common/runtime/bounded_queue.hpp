#pragma once

#include <atomic>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <utility>

#include "common/base/expects.hpp"

namespace limbcast::runtime {

/// A queue of fixed size from any number of producers to one consumer. All elements live in one
/// array made at construction: no allocation, no lock. What one producer pushes is popped in its
/// order, and pushes that happen one after the other (in whatever threads) keep that order.
///
/// Ring of numbered cells after Dmitry Vyukov, "Bounded MPMC queue" (1024cores.net), with one
/// consumer. T is default-constructible and assignable; a popped cell keeps a moved-from T.
template <typename T>
class BoundedQueue {
 public:
  /// Holds at least `capacity` elements (the next power of two). Range: [1, 2^24].
  explicit BoundedQueue(std::size_t capacity)
      : mask_(std::bit_ceil(capacity) - 1), cells_(std::make_unique<Cell[]>(mask_ + 1)) {
    Expects(capacity >= 1 && capacity <= (std::size_t{1} << 24U), "a capacity in [1, 2^24]");
    for (std::size_t i = 0; i <= mask_; ++i) {
      cells_[i].turn.store(i, std::memory_order_relaxed);
    }
  }

  /// False when less than `keep_free` + 1 places are free: ordinary traffic leaves some for what
  /// must not be refused. Any thread.
  [[nodiscard]] bool TryPush(T value, std::size_t keep_free = 0) {
    std::size_t at = tail_.load(std::memory_order_relaxed);
    while (true) {
      // head_ may lag behind: then the queue looks fuller than it is, never emptier. It may also be
      // past an `at` that is old by now: then used < 0, and the cell's turn sends us round again.
      const auto used = static_cast<std::ptrdiff_t>(at - head_.load(std::memory_order_acquire));
      if (used + static_cast<std::ptrdiff_t>(keep_free) > static_cast<std::ptrdiff_t>(mask_)) {
        return false;
      }
      Cell& cell = cells_[at & mask_];
      const std::size_t turn = cell.turn.load(std::memory_order_acquire);
      if (turn == at) {
        if (tail_.compare_exchange_weak(at, at + 1, std::memory_order_relaxed)) {
          cell.value = std::move(value);
          cell.turn.store(at + 1, std::memory_order_release);
          return true;
        }
      } else {
        at = tail_.load(std::memory_order_relaxed);
      }
    }
  }

  /// False when empty. One thread.
  [[nodiscard]] bool TryPop(T& value) {
    const std::size_t at = head_.load(std::memory_order_relaxed);
    Cell& cell = cells_[at & mask_];
    if (cell.turn.load(std::memory_order_acquire) != at + 1) {
      return false;
    }
    value = std::move(cell.value);
    cell.turn.store(at + mask_ + 1, std::memory_order_release);
    head_.store(at + 1, std::memory_order_release);
    return true;
  }

  /// Elements now; other threads may change it at once.
  [[nodiscard]] std::size_t size() const {
    const std::size_t head = head_.load(std::memory_order_acquire);
    return tail_.load(std::memory_order_acquire) - head;
  }
  [[nodiscard]] std::size_t capacity() const { return mask_ + 1; }

 private:
  struct Cell {
    std::atomic<std::size_t> turn{0};  // i: free for push number i; i + 1: holds its value
    T value{};
  };
  const std::size_t mask_;
  const std::unique_ptr<Cell[]> cells_;
  alignas(64) std::atomic<std::size_t> tail_{0};  // producers
  alignas(64) std::atomic<std::size_t> head_{0};  // consumer
};

}  // namespace limbcast::runtime
