// Time of one sample on one core, every filter of the factory in the same run, at 285 Hz like
// BROAD.
#include <benchmark/benchmark.h>

#include <string>
#include <vector>

#include "common/filters/filter_factory.hpp"
#include "tests/unit/common/filters/marg_stream.hpp"

namespace limbcast::filters {
namespace {

constexpr int kSamples = 20'000;  // 70 s of a moving limb

const std::vector<sensing::MargSample>& MovingLimb() {
  static const std::vector<sensing::MargSample> samples = [] {
    test_support::MargStreamConfig config;
    config.rate_hz = 2000.0 / 7.0;
    config.rest_s = 3.0;
    config.accel_rms_m_s2 = 2.0;
    config.gyro_noise_rad_s = 0.002;
    config.accel_noise_m_s2 = 0.05;
    config.mag_noise_tesla = 5e-7;
    test_support::MargStream stream(config);
    std::vector<sensing::MargSample> made;
    made.reserve(kSamples);
    for (int i = 0; i < kSamples; ++i) {
      made.push_back(stream.Next());
    }
    return made;
  }();
  return samples;
}

void BM_FilterUpdate(benchmark::State& state, const std::string& name,
                     const std::vector<Setting>& settings) {
  const auto& samples = MovingLimb();
  auto filter = MakeFilter(name, settings);
  for (auto _ : state) {
    (*filter)->Reset();
    for (const auto& sample : samples) {
      benchmark::DoNotOptimize((*filter)->Update(sample));
    }
  }
  const auto items = state.iterations() * static_cast<std::int64_t>(samples.size());
  state.SetItemsProcessed(items);
  state.counters["ns_per_sample"] = benchmark::Counter(
      static_cast<double>(items) * 1e-9, benchmark::Counter::kIsRate | benchmark::Counter::kInvert);
}

BENCHMARK_CAPTURE(BM_FilterUpdate, tqt_reduced, "tqt", {})->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(BM_FilterUpdate, tqt_float, "tqt", {{"precision", "float"}})
    ->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(BM_FilterUpdate, tqt_full, "tqt", {{"form", "full"}})
    ->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(BM_FilterUpdate, ckf, "ckf", {})->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(BM_FilterUpdate, bmf_double, "bmf", {{"precision", "double"}})
    ->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(BM_FilterUpdate, bmf_float, "bmf", {{"precision", "float"}})
    ->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace limbcast::filters
