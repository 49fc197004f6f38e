#pragma once

#include <array>
#include <atomic>
#include <cstddef>
#include <cstdint>

#include "common/base/verdict.hpp"

namespace limbcast::fusion {

/// What became of all samples of the service so far; a snapshot.
struct FusionCounters {
  std::uint64_t received = 0;  ///< samples without probes; the sum of `verdicts`
  std::uint64_t probes = 0;
  std::int64_t lost = 0;  ///< missing in the numbers; a late arrival takes one back
  std::uint64_t published = 0;
  std::uint64_t publish_errors = 0;
  std::uint64_t positions = 0;         ///< states with a position
  std::uint64_t restored = 0;          ///< sensors whose filter went on from a saved state
  std::uint64_t queue_high_water = 0;  ///< most samples that ever waited for one worker
  VerdictCounters verdicts;
};

/// The same, counted by one thread (or under one lock) and read by any. Relaxed: the numbers belong
/// together only when the counting thread rests.
class CounterCells {
 public:
  void Add(SampleVerdict verdict) { Bump(verdicts_[static_cast<std::size_t>(verdict)], 1); }
  void AddProbe() { Bump(probes_, 1); }
  void AddLost(std::int64_t lost) {
    lost_.store(lost_.load(std::memory_order_relaxed) + lost, std::memory_order_relaxed);
  }
  void AddPosition(bool there) { Bump(positions_, there ? 1 : 0); }
  void AddRestored() { Bump(restored_, 1); }
  void AddPublished(bool ok) { Bump(ok ? published_ : publish_errors_, 1); }
  void SawQueue(std::uint64_t length) {
    if (length > queue_high_water_.load(std::memory_order_relaxed)) {
      queue_high_water_.store(length, std::memory_order_relaxed);
    }
  }

  void AddTo(FusionCounters& sum) const {
    for (std::size_t i = 0; i < kSampleVerdictCount; ++i) {
      const std::uint64_t count = verdicts_[i].load(std::memory_order_relaxed);
      sum.verdicts.count[i] += count;
      sum.received += count;
    }
    sum.probes += probes_.load(std::memory_order_relaxed);
    sum.lost += lost_.load(std::memory_order_relaxed);
    sum.positions += positions_.load(std::memory_order_relaxed);
    sum.restored += restored_.load(std::memory_order_relaxed);
    sum.published += published_.load(std::memory_order_relaxed);
    sum.publish_errors += publish_errors_.load(std::memory_order_relaxed);
    const std::uint64_t high = queue_high_water_.load(std::memory_order_relaxed);
    sum.queue_high_water = high > sum.queue_high_water ? high : sum.queue_high_water;
  }

 private:
  using Cell = std::atomic<std::uint64_t>;
  // One writer: a load and a store are enough, and cheaper than a locked add.
  static void Bump(Cell& cell, std::uint64_t by) {
    cell.store(cell.load(std::memory_order_relaxed) + by, std::memory_order_relaxed);
  }
  std::array<Cell, kSampleVerdictCount> verdicts_{};
  Cell probes_{0};
  std::atomic<std::int64_t> lost_{0};
  Cell positions_{0};
  Cell restored_{0};
  Cell published_{0};
  Cell publish_errors_{0};
  Cell queue_high_water_{0};
};

}  // namespace limbcast::fusion
