#pragma once

#include <array>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <string>

#include "common/base/health.hpp"
#include "common/base/time.hpp"

namespace limbcast::runtime {

/// Latencies of one stage in fixed log-linear buckets (32 in each power of two, so a quantile is
/// off by at most 1/32 = 3.2 %; the maximum is exact). Range: up to 1099 s (2^40 ns), more counts
/// as that; negative ones (clocks of two hosts apart) as zero. No allocation, no lock: Record from
/// any thread costs one atomic add.
class LatencyHistogram {
 public:
  void Record(Duration latency);

  /// What was recorded since the last Take; starts a new period. Records that run at the same time
  /// fall into this or the next period, none is lost. One taking thread.
  [[nodiscard]] LatencyQuantiles Take(std::string stage);

  /// What the fraction `fraction` (0 to 1) of all records since the last Take is at or below [µs];
  /// 0 when there is none.
  [[nodiscard]] double Quantile_us(double fraction) const;

  [[nodiscard]] std::uint64_t count() const;

 private:
  static constexpr std::size_t kSubBucketBits = 5;
  static constexpr std::size_t kSubBuckets = std::size_t{1} << kSubBucketBits;
  static constexpr std::size_t kMaxBits = 40;
  static constexpr std::size_t kBuckets = (kMaxBits - kSubBucketBits + 1) * kSubBuckets;

  static std::size_t BucketOf(std::uint64_t ns);
  static double MiddleOf_ns(std::size_t bucket);

  std::array<std::atomic<std::uint32_t>, kBuckets> counts_{};
  std::atomic<std::uint64_t> max_ns_{0};
};

}  // namespace limbcast::runtime
