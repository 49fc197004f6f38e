#include "common/runtime/latency_histogram.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <utility>

namespace limbcast::runtime {

// Values below kSubBuckets have a bucket each. Above, a value with its highest bit at position b
// falls into group b - kSubBucketBits + 1, at the place that the next kSubBucketBits bits give.
std::size_t LatencyHistogram::BucketOf(std::uint64_t ns) {
  ns = std::min(ns, (std::uint64_t{1} << kMaxBits) - 1);
  if (ns < kSubBuckets) {
    return static_cast<std::size_t>(ns);
  }
  const auto top_bit = static_cast<std::size_t>(std::bit_width(ns)) - 1;
  const std::size_t shift = top_bit - kSubBucketBits;
  const auto place = static_cast<std::size_t>(ns >> shift) - kSubBuckets;
  return (shift + 1) * kSubBuckets + place;
}

double LatencyHistogram::MiddleOf_ns(std::size_t bucket) {
  const std::size_t group = bucket / kSubBuckets;
  const std::size_t place = bucket % kSubBuckets;
  if (group == 0) {
    return static_cast<double>(place);
  }
  return std::ldexp(static_cast<double>(kSubBuckets + place) + 0.5, static_cast<int>(group) - 1);
}

void LatencyHistogram::Record(Duration latency) {
  const auto ns = static_cast<std::uint64_t>(std::max<std::int64_t>(latency.count(), 0));
  counts_[BucketOf(ns)].fetch_add(1, std::memory_order_relaxed);
  std::uint64_t max = max_ns_.load(std::memory_order_relaxed);
  while (ns > max && !max_ns_.compare_exchange_weak(max, ns, std::memory_order_relaxed)) {
  }
}

namespace {

// The first bucket that has at least the fraction q of all at or below it.
template <typename Counts>
std::size_t QuantileBucket(const Counts& counts, std::uint64_t total, double q) {
  const auto wanted = static_cast<std::uint64_t>(std::ceil(q * static_cast<double>(total)));
  std::uint64_t seen = 0;
  std::size_t bucket = 0;
  while (bucket + 1 < counts.size() && (seen += counts[bucket]) < wanted) {
    ++bucket;
  }
  return bucket;
}

constexpr double kNanosecondsPerMicrosecond = 1e3;

}  // namespace

LatencyQuantiles LatencyHistogram::Take(std::string stage) {
  std::array<std::uint32_t, kBuckets> taken;  // NOLINT: every element is written below
  std::uint64_t total = 0;
  for (std::size_t i = 0; i < kBuckets; ++i) {
    taken[i] = counts_[i].exchange(0, std::memory_order_relaxed);
    total += taken[i];
  }
  const double max_ns = static_cast<double>(max_ns_.exchange(0, std::memory_order_relaxed));

  const auto quantile_us = [&](double q) {
    const double ns = std::min(MiddleOf_ns(QuantileBucket(taken, total, q)), max_ns);
    return static_cast<float>(ns / kNanosecondsPerMicrosecond);
  };

  LatencyQuantiles result;
  result.stage = std::move(stage);
  result.count = total;
  if (total > 0) {
    result.p50_us = quantile_us(0.50);
    result.p99_us = quantile_us(0.99);
    result.max_us = static_cast<float>(max_ns / kNanosecondsPerMicrosecond);
  }
  return result;
}

double LatencyHistogram::Quantile_us(double fraction) const {
  std::array<std::uint32_t, kBuckets> counts;  // NOLINT: every element is written below
  std::uint64_t total = 0;
  for (std::size_t i = 0; i < kBuckets; ++i) {
    counts[i] = counts_[i].load(std::memory_order_relaxed);
    total += counts[i];
  }
  if (total == 0) {
    return 0.0;
  }
  const double max_ns = static_cast<double>(max_ns_.load(std::memory_order_relaxed));
  return std::min(MiddleOf_ns(QuantileBucket(counts, total, fraction)), max_ns) /
         kNanosecondsPerMicrosecond;
}

std::uint64_t LatencyHistogram::count() const {
  std::uint64_t total = 0;
  for (const auto& count : counts_) {
    total += count.load(std::memory_order_relaxed);
  }
  return total;
}

}  // namespace limbcast::runtime
