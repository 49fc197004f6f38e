// Time of one epoch of the inertial + optical filter on one core, with and without fixed-lag
// output, 200 Hz inertial and optical; in gaps as well.
#include <benchmark/benchmark.h>

#include "common/filters/position/fixed_lag_position.hpp"
#include "tests/unit/common/filters/position/optical_scene.hpp"

namespace limbcast::filters {
namespace {

const test_support::OpticalScene& Hand(bool with_gaps) {
  const auto make = [](bool gaps) {
    test_support::OpticalSceneConfig config;
    config.motion_s = 30.0;
    config.gyro_noise_rad_s = 0.002;
    config.accel_noise_m_s2 = 0.03;
    config.marker_noise_m = 1.5e-4;
    test_support::OpticalScene scene(config);
    for (std::size_t row = 2000; gaps && row + 100 < scene.rows(); row += 200) {
      scene.Hide(row, row + 100);
    }
    return scene;
  };
  static const test_support::OpticalScene plain = make(false);
  static const test_support::OpticalScene broken = make(true);
  return with_gaps ? broken : plain;
}

void BM_Position(benchmark::State& state, double lag_s, bool with_gaps) {
  const test_support::OpticalScene& scene = Hand(with_gaps);
  OpticalInertialConfig config;
  config.lag_s = lag_s;
  std::int64_t epochs = 0;
  for (auto _ : state) {
    OpticalInertialFilter filter(config);
    FixedLagPosition lag(config);
    for (std::size_t row = 0; row < scene.rows(); ++row) {
      if (test_support::FeedRow(filter, scene, row).epoch_closed) {
        ++epochs;
        if (lag_s > 0.0) {
          lag.Push(filter.epoch());
          benchmark::DoNotOptimize(lag.estimate());
        }
      }
    }
  }
  state.SetItemsProcessed(epochs);
  state.counters["s_per_epoch"] = benchmark::Counter(
      static_cast<double>(epochs), benchmark::Counter::kIsRate | benchmark::Counter::kInvert);
}

BENCHMARK_CAPTURE(BM_Position, forward, 0.0, false)->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(BM_Position, fixed_lag_500ms, 0.5, false)->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(BM_Position, fixed_lag_500ms_half_gaps, 0.5, true)->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace limbcast::filters
