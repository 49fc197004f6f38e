// Time of one sample of one sensor when several are filtered together: the kernels alone, on
// samples that have passed the gate, from memory in the order of the blocks.
#include "common/filters/batch_kernels.hpp"

#include <benchmark/benchmark.h>

#include <string>
#include <vector>

#include "common/filters/bounded_motion_core.hpp"
#include "common/filters/filter_batches.hpp"
#include "common/filters/filter_factory.hpp"
#include "common/filters/gauss_newton_core.hpp"
#include "common/filters/lane_block.hpp"
#include "tests/unit/common/filters/marg_stream.hpp"

namespace limbcast::filters {
namespace {

constexpr int kSensors = 8;
constexpr int kSamples = 2'000;

struct alignas(kBlockAlignment_bytes) Cell {
  std::byte bytes[kBlockAlignment_bytes];
};

std::vector<sensing::MargSample> MovingLimb(unsigned seed, double rate_hz) {
  test_support::MargStreamConfig config;
  config.seed = seed;
  config.rate_hz = rate_hz;
  config.rest_s = 1.0;
  config.accel_rms_m_s2 = 2.0;
  config.gyro_noise_rad_s = 0.002;
  config.accel_noise_m_s2 = 0.05;
  config.mag_noise_tesla = 5e-7;
  test_support::MargStream stream(config);
  std::vector<sensing::MargSample> samples;
  for (int i = 0; i < kSamples; ++i) {
    samples.push_back(stream.Next());
  }
  return samples;
}

template <typename S>
kernel::Vector<S> Plain(const Eigen::Vector3f& v) {
  return {static_cast<S>(v.x()), static_cast<S>(v.y()), static_cast<S>(v.z())};
}

template <typename Record>
class Blocks {
 public:
  Blocks(int count, int width)
      : width_(width),
        cells_((sizeof(Record) * static_cast<std::size_t>(width) + sizeof(Cell) - 1) /
               sizeof(Cell)),
        memory_(static_cast<std::size_t>(count) * cells_) {}
  std::byte* operator[](int i) { return memory_[static_cast<std::size_t>(i) * cells_].bytes; }

 private:
  int width_;
  std::size_t cells_;
  std::vector<Cell> memory_;
};

void SetTime(benchmark::State& state) {
  const auto items = state.iterations() * kSamples * kSensors;
  state.SetItemsProcessed(items);
  state.counters["ns_per_sample"] = benchmark::Counter(
      static_cast<double>(items) * 1e-9, benchmark::Counter::kIsRate | benchmark::Counter::kInvert);
}

template <typename S>
void BM_GaussNewton(benchmark::State& state, const BatchKernels* kernels) {
  using Input = GaussNewtonInput<S>;
  using State = GaussNewtonState<S>;
  if (kernels == nullptr) {
    state.SkipWithError("not on this machine");
    return;
  }
  const double rate_hz = static_cast<double>(state.range(0));
  constexpr bool kIsDouble = sizeof(S) == sizeof(double);
  const int width = kIsDouble ? kernels->width_double : kernels->width_float;
  const auto step = kIsDouble ? kernels->gauss_newton_double : kernels->gauss_newton_float;
  const int groups = kSensors / width;
  Blocks<Input> inputs(kSamples * groups, width);
  Blocks<State> states(groups, width);
  for (int sensor = 0; sensor < kSensors; ++sensor) {
    const auto samples = MovingLimb(static_cast<unsigned>(sensor), rate_hz);
    for (int i = 0; i < kSamples; ++i) {
      const auto& sample = samples[static_cast<std::size_t>(i)];
      const Input input{.present = S(1),
                        .dt_s = static_cast<S>(1.0 / rate_hz),
                        .unseen_rad2 = S(0),
                        .gyro_rad_s = Plain<S>(sample.gyro_rad_s),
                        .accel_m_s2 = Plain<S>(sample.accel_m_s2),
                        .mag_tesla = Plain<S>(sample.mag_tesla),
                        .gyro_measured = S(1),
                        .gyro_usable = S(1),
                        .accel_valid = S(1),
                        .use_field = S(1)};
      lanes::PutLane<Input, S>(inputs[i * groups + sensor / width], width, sensor % width, input);
    }
    State start{};
    start.q_ES.w = S(1.0);
    start.field_north = S(0.39);
    start.field_up = S(-0.92);
    start.inverse_field_per_tesla = S(1.0 / 48e-6);
    start.has_field = S(1.0);
    start.null_known = S(1.0);
    lanes::PutLane<State, S>(states[sensor / width], width, sensor % width, start);
  }
  const GaussNewtonConfig config;
  for (auto _ : state) {
    for (int i = 0; i < kSamples; ++i) {
      for (int group = 0; group < groups; ++group) {
        step(config, inputs[i * groups + group], states[group]);
      }
    }
    benchmark::ClobberMemory();
  }
  SetTime(state);
}

template <typename S>
void BM_BoundedMotion(benchmark::State& state, const BatchKernels* kernels) {
  using Input = BoundedMotionInput<S>;
  using State = BoundedMotionState<S>;
  if (kernels == nullptr) {
    state.SkipWithError("not on this machine");
    return;
  }
  const double rate_hz = static_cast<double>(state.range(0));
  constexpr bool kIsDouble = sizeof(S) == sizeof(double);
  const int width = kIsDouble ? kernels->width_double : kernels->width_float;
  const auto step = kIsDouble ? kernels->bounded_motion_double : kernels->bounded_motion_float;
  const int groups = kSensors / width;
  Blocks<Input> inputs(kSamples * groups, width);
  Blocks<State> states(groups, width);
  const BoundedMotionConfig config;
  BoundedMotionCore<S> start(config);
  start.Start(Eigen::Quaternion<S>::Identity(), {S(0), S(19e-6), S(-44e-6)}, false);
  for (int sensor = 0; sensor < kSensors; ++sensor) {
    const auto samples = MovingLimb(static_cast<unsigned>(sensor), rate_hz);
    for (int i = 0; i < kSamples; ++i) {
      const auto& sample = samples[static_cast<std::size_t>(i)];
      Input input;
      input.dt_s = static_cast<S>(1.0 / rate_hz);
      input.gyro_rad_s = sample.gyro_rad_s.cast<S>();
      input.accel_m_s2 = sample.accel_m_s2.cast<S>();
      input.mag = sample.mag_tesla.cast<S>();
      lanes::PutLane<Input, S>(inputs[i * groups + sensor / width], width, sensor % width, input);
    }
    lanes::PutLane<State, S>(states[sensor / width], width, sensor % width, start.state());
  }
  for (auto _ : state) {
    for (int i = 0; i < kSamples; ++i) {
      for (int group = 0; group < groups; ++group) {
        step(config, inputs[i * groups + group], states[group]);
      }
    }
    benchmark::ClobberMemory();
  }
  SetTime(state);
}

void BM_GaussNewtonDouble(benchmark::State& state, const BatchKernels* kernels) {
  BM_GaussNewton<double>(state, kernels);
}
void BM_GaussNewtonFloat(benchmark::State& state, const BatchKernels* kernels) {
  BM_GaussNewton<float>(state, kernels);
}

BENCHMARK_CAPTURE(BM_GaussNewtonDouble, avx2, Avx2Kernels())->Arg(286)->Arg(100);
BENCHMARK_CAPTURE(BM_GaussNewtonFloat, avx2, Avx2Kernels())->Arg(286)->Arg(100);
BENCHMARK_CAPTURE(BM_GaussNewtonDouble, baseline, &BaselineKernels())->Arg(286)->Arg(100);
BENCHMARK_CAPTURE(BM_GaussNewtonFloat, baseline, &BaselineKernels())->Arg(286)->Arg(100);
void BM_BoundedMotionDouble(benchmark::State& state, const BatchKernels* kernels) {
  BM_BoundedMotion<double>(state, kernels);
}
void BM_BoundedMotionFloat(benchmark::State& state, const BatchKernels* kernels) {
  BM_BoundedMotion<float>(state, kernels);
}

BENCHMARK_CAPTURE(BM_BoundedMotionDouble, avx2, Avx2Kernels())->Arg(286)->Arg(100);
BENCHMARK_CAPTURE(BM_BoundedMotionFloat, avx2, Avx2Kernels())->Arg(286)->Arg(100);
BENCHMARK_CAPTURE(BM_BoundedMotionDouble, baseline, &BaselineKernels())->Arg(286)->Arg(100);
BENCHMARK_CAPTURE(BM_BoundedMotionFloat, baseline, &BaselineKernels())->Arg(286)->Arg(100);

// The whole way from samples to estimates: gate, blocks, kernel, report.
void BM_FilterBatches(benchmark::State& state, const std::string& name,
                      const std::vector<Setting>& settings) {
  const double rate_hz = static_cast<double>(state.range(0));
  FilterBatches batches;
  std::vector<std::unique_ptr<OrientationFilter>> filters;
  std::vector<std::vector<sensing::MargSample>> samples;
  for (int sensor = 0; sensor < kSensors; ++sensor) {
    samples.push_back(MovingLimb(static_cast<unsigned>(sensor), rate_hz));
    filters.push_back(batches.Seat(std::move(*MakeFilter(name, settings))));
  }
  for (auto _ : state) {
    for (const auto& filter : filters) {
      filter->Reset();
    }
    for (std::size_t i = 0; i < kSamples; ++i) {
      for (std::size_t sensor = 0; sensor < kSensors; ++sensor) {
        filters[sensor]->batched()->Submit(samples[sensor][i]);
      }
      batches.Run();
      for (const auto& filter : filters) {
        benchmark::DoNotOptimize(filter->batched()->Take());
      }
    }
  }
  SetTime(state);
}

BENCHMARK_CAPTURE(BM_FilterBatches, tqt, "tqt", {})->Arg(286)->Arg(100);
BENCHMARK_CAPTURE(BM_FilterBatches, tqt_float, "tqt", {{"precision", "float"}})->Arg(286)->Arg(100);
BENCHMARK_CAPTURE(BM_FilterBatches, bmf_double, "bmf", {{"precision", "double"}})
    ->Arg(286)
    ->Arg(100);
BENCHMARK_CAPTURE(BM_FilterBatches, bmf_float, "bmf", {{"precision", "float"}})->Arg(286)->Arg(100);

}  // namespace
}  // namespace limbcast::filters
