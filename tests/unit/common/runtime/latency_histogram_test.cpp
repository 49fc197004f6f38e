#include "common/runtime/latency_histogram.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <random>
#include <thread>
#include <vector>

namespace limbcast::runtime {
namespace {

using namespace std::chrono_literals;
constexpr float kRelativeError = 1.0F / 32.0F;  // one bucket: 32 in each power of two

TEST(LatencyHistogramTest, IsEmptyBeforeTheFirstRecordAndAfterATake) {
  LatencyHistogram histogram;
  histogram.Record(5us);
  EXPECT_EQ(histogram.count(), 1U);
  EXPECT_EQ(histogram.Take("stage").count, 1U);
  const LatencyQuantiles empty = histogram.Take("stage");
  EXPECT_EQ(empty, (LatencyQuantiles{.stage = "stage"}));
}

TEST(LatencyHistogramTest, OneRecordIsEveryQuantile) {
  for (const Duration latency : {Duration{1}, Duration{31}, Duration{32}, Duration{33},
                                 Duration{1us}, Duration{123'456}, Duration{1s}, Duration{1000s}}) {
    LatencyHistogram histogram;
    histogram.Record(latency);
    const LatencyQuantiles quantiles = histogram.Take("x");
    const float us = static_cast<float>(latency.count()) / 1e3F;
    EXPECT_NEAR(quantiles.p50_us, us, us * kRelativeError);
    EXPECT_NEAR(quantiles.p99_us, us, us * kRelativeError);
    EXPECT_FLOAT_EQ(quantiles.max_us, us) << "the maximum is exact";
  }
}

TEST(LatencyHistogramTest, QuantilesOfALongTailAreThoseOfTheSortedValues) {
  std::mt19937 rng(20240517);
  std::lognormal_distribution<double> latency_ns(11.0, 1.5);  // around 60 µs, tail of milliseconds
  std::vector<std::int64_t> values;
  LatencyHistogram histogram;
  for (int i = 0; i < 10'000; ++i) {
    values.push_back(static_cast<std::int64_t>(latency_ns(rng)));
    histogram.Record(Duration{values.back()});
  }
  std::sort(values.begin(), values.end());
  const double p999_us = histogram.Quantile_us(0.999);
  const LatencyQuantiles quantiles = histogram.Take("tail");
  const auto sorted_us = [&](std::size_t rank) {
    return static_cast<float>(values[rank - 1]) / 1e3F;
  };
  EXPECT_EQ(quantiles.count, 10'000U);
  EXPECT_NEAR(quantiles.p50_us, sorted_us(5'000), sorted_us(5'000) * kRelativeError);
  EXPECT_NEAR(quantiles.p99_us, sorted_us(9'900), sorted_us(9'900) * kRelativeError);
  EXPECT_NEAR(p999_us, sorted_us(9'990), sorted_us(9'990) * kRelativeError);
  EXPECT_EQ(histogram.Quantile_us(0.5), 0.0) << "nothing is left after Take";
  EXPECT_FLOAT_EQ(quantiles.max_us, sorted_us(10'000));
}

TEST(LatencyHistogramTest, NegativeCountsAsZeroAndBeyondTheRangeAsItsEnd) {
  LatencyHistogram histogram;
  histogram.Record(-1s);
  EXPECT_EQ(histogram.Take("x").p99_us, 0.0F);
  histogram.Record(std::chrono::hours(1));
  EXPECT_FLOAT_EQ(histogram.Take("x").max_us, 3.6e9F);
}

TEST(LatencyHistogramTest, NothingIsLostWhenThreadsRecordWhileOneTakes) {
  constexpr int kThreads = 3;
  constexpr std::uint64_t kEach = 20'000;
  LatencyHistogram histogram;
  std::vector<std::thread> threads;
  for (int t = 0; t < kThreads; ++t) {
    threads.emplace_back([&] {
      for (std::uint64_t i = 0; i < kEach; ++i) {
        histogram.Record(Duration{static_cast<std::int64_t>(i)});
      }
    });
  }
  std::uint64_t taken = 0;
  for (int i = 0; i < 20; ++i) {
    taken += histogram.Take("x").count;
  }
  for (std::thread& thread : threads) {
    thread.join();
  }
  taken += histogram.Take("x").count;
  EXPECT_EQ(taken, kThreads * kEach);
}

}  // namespace
}  // namespace limbcast::runtime
