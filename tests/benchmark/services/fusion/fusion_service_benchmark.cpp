// What the fusion service costs beyond its filter, and how many samples go through it.
//
//   BM_FilterAlone        the shipped filter, one sensor: the work that has to be done
//   BM_ServiceInline      sample → inproc bus → route → queue → filter → state → inproc reader, all
//                         on one thread: minus BM_FilterAlone = overhead for each sample
//   BM_ServiceThreads/N   the same with N worker threads, 4 bodies of 15 sensors, as fast as it
//   goes
#include <benchmark/benchmark.h>

#include <atomic>
#include <chrono>
#include <cmath>
#include <memory>
#include <vector>

#include "common/bus/inproc/inproc_bus.hpp"
#include "common/runtime/system_clock.hpp"
#include "common/runtime/thread_pool.hpp"
#include "services/fusion/fusion_service.hpp"
#include "tests/support/immediate_pool.hpp"

namespace limbcast::fusion {
namespace {

constexpr std::uint32_t kBodies = 4;
constexpr std::uint32_t kSensors = 15;
constexpr std::uint32_t kSamples = kBodies * kSensors * 100;

// A swinging arm, sensor after sensor, tick after tick, numbers and times going on for ever.
class Samples {
 public:
  explicit Samples(std::uint32_t sensors) : sensors_(sensors) {}
  const sensing::MargSample& Next() {
    if (++index_ % sensors_ == 0) {
      ++sample_.sequence;
      sample_.measured_at += std::chrono::milliseconds(10);
      const double phase = 0.05 * sample_.sequence;
      sample_.gyro_rad_s = {static_cast<float>(2.0 * std::cos(phase)), 0.1F, -0.1F};
      sample_.accel_m_s2 = {0.1F, static_cast<float>(-9.81 * std::sin(0.5 * std::sin(phase))),
                            static_cast<float>(9.81 * std::cos(0.5 * std::sin(phase)))};
      sample_.mag_tesla = {1e-6F, 2e-5F, -4e-5F};
    }
    sample_.sensor_uid = SensorUid{1 + index_ % sensors_};
    return sample_;
  }

 private:
  const std::uint32_t sensors_;
  std::uint32_t index_ = 0;
  sensing::MargSample sample_ = [] {
    sensing::MargSample first;
    first.measured_at = TimeFromNanoseconds(1'700'000'000'000'000'000);
    first.accel_m_s2.z() = 9.81F;
    first.mag_tesla = {1e-6F, 2e-5F, -4e-5F};
    return first;
  }();
};

void Count(benchmark::State& state) {
  state.SetItemsProcessed(state.iterations() * kSamples);
  state.counters["ns_per_sample"] = benchmark::Counter(
      kSamples * 1e-9, benchmark::Counter::kIsIterationInvariantRate | benchmark::Counter::kInvert);
}

void BM_FilterAlone(benchmark::State& state) {
  std::vector<std::unique_ptr<filters::OrientationFilter>> filters;
  for (std::uint32_t i = 0; i < kBodies * kSensors; ++i) {
    filters.push_back(std::move(*filters::MakeFilter(FusionConfig{}.filter.name)));
  }
  Samples samples(kBodies * kSensors);
  for (auto _ : state) {
    for (std::uint32_t i = 0; i < kSamples; ++i) {
      const sensing::MargSample& sample = samples.Next();
      benchmark::DoNotOptimize(filters[sample.sensor_uid.value - 1]->Update(sample));
    }
  }
  Count(state);
}
BENCHMARK(BM_FilterAlone)->Unit(benchmark::kMicrosecond);

// Sends kSamples in each iteration and waits until each was answered.
void RunService(benchmark::State& state, runtime::WorkerPool& pool) {
  const runtime::SystemClock clock;
  const auto hub = bus::inproc::MakeHub();
  const auto bus = bus::inproc::MakeBus(hub);
  FusionService service(FusionConfig{}, clock, *bus, pool);
  if (!service.Start()) {
    state.SkipWithError("the service did not start");
    return;
  }
  std::atomic<std::uint64_t> answered{0};
  const auto reader = *bus->MakeReader<body::SegmentState>(
      {.on_sample =
           [&](const body::SegmentState&, const bus::SampleInfo&) {
             answered.fetch_add(1, std::memory_order_relaxed);
           },
       .on_disposed = {}});
  const auto roster = *bus->MakeWriter<roster::RosterEntry>();
  for (std::uint32_t b = 0; b < kBodies; ++b) {
    roster::RosterEntry entry;
    entry.body_id = BodyId{b + 1};
    for (std::uint32_t s = 0; s < kSensors; ++s) {
      entry.sensors.push_back({SensorUid{1 + b * kSensors + s}, body::AllSegments()[s]});
    }
    if (!roster->Write(entry)) {
      state.SkipWithError("the roster was refused");
    }
  }
  const auto marg = *bus->MakeWriter<sensing::MargSample>();
  Samples samples(kBodies * kSensors);
  std::uint64_t sent = 0;
  for (auto _ : state) {
    for (std::uint32_t i = 0; i < kSamples; ++i) {
      if (!marg->Write(samples.Next())) {
        state.SkipWithError("a sample was refused");
      }
    }
    sent += kSamples;
    while (answered.load(std::memory_order_relaxed) < sent) {
      std::this_thread::yield();
    }
  }
  service.Stop();
  if (service.counters().verdicts[SampleVerdict::kRejectedOverload] > 0) {
    state.SkipWithError("overload: the numbers mean nothing");
  }
  Count(state);
}

void BM_ServiceInline(benchmark::State& state) {
  test_support::ImmediatePool pool;
  RunService(state, pool);
}
BENCHMARK(BM_ServiceInline)->Unit(benchmark::kMicrosecond);

void BM_ServiceThreads(benchmark::State& state) {
  runtime::ThreadPool pool("fusion", static_cast<std::size_t>(state.range(0)));
  RunService(state, pool);
}
BENCHMARK(BM_ServiceThreads)->Arg(1)->Arg(2)->Unit(benchmark::kMicrosecond)->UseRealTime();

}  // namespace
}  // namespace limbcast::fusion
