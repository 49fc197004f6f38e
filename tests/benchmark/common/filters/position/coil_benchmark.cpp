// Time of one frame of the magnetic + inertial filter on one core, 120 Hz, a magnetometer sample
// with each: forward, with a fixed lag, and both sides of a start.
#include <benchmark/benchmark.h>

#include "common/filters/position/coil_both_sides.hpp"
#include "common/filters/position/coil_smoothing.hpp"
#include "tests/unit/common/filters/position/coil_scene.hpp"

namespace limbcast::filters {
namespace {

const std::vector<simulation::CoilTick>& Arm() {
  static const std::vector<simulation::CoilTick> ticks =
      SwingingSensor(true, simulation::ThesisPulses(), 30.0, 1);
  return ticks;
}

void SetTime(benchmark::State& state) {
  const auto frames = state.iterations() * static_cast<std::int64_t>(Arm().size());
  state.SetItemsProcessed(frames);
  state.counters["s_per_frame"] = benchmark::Counter(
      static_cast<double>(frames), benchmark::Counter::kIsRate | benchmark::Counter::kInvert);
}

void BM_CoilFrame(benchmark::State& state, double lag_s) {
  for (auto _ : state) {
    auto filter = CoilInertialFilter::Make(SwingConfig());
    CoilFixedLag lag(lag_s > 0.0 ? lag_s : 1.0, 120.0);
    CoilEstimate lagged;
    for (const simulation::CoilTick& tick : Arm()) {
      benchmark::DoNotOptimize(filter->Update(tick.frame));
      if (lag_s > 0.0) {
        benchmark::DoNotOptimize(lag.Update(*filter, tick.frame.measured_at, lagged));
      }
    }
  }
  SetTime(state);
}

void BM_CoilFrameBothSides(benchmark::State& state) {
  for (auto _ : state) {
    auto sides = CoilBothSides::Make(CoilInertialConfig());
    for (const simulation::CoilTick& tick : Arm()) {
      benchmark::DoNotOptimize(sides->Update(tick.frame));
    }
  }
  SetTime(state);
}

BENCHMARK_CAPTURE(BM_CoilFrame, forward, 0.0)->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(BM_CoilFrame, fixed_lag_500ms, 0.5)->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(BM_CoilFrame, fixed_lag_600ms, 0.6)->Unit(benchmark::kMillisecond);
BENCHMARK(BM_CoilFrameBothSides)->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace limbcast::filters
