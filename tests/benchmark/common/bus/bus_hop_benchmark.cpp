// One hop of MargSample between two processes through the bus, to be put beside ../shared/bench/dds
// (run_pair.sh B cycx_bench cycx_bench "rate=1000 burst=15"): one-way latency and CPU per sample.
//
//   bus_hop_benchmark [cyclone|fast] [bursts/s = 100] [samples/burst = 15] [seconds = 5] [batching]
//
// The writer is a child process. Latency is received_at - published_at on one clock, so it contains
// encoding, both libraries' threads and the kernel, and not the decoding after received_at.

#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

#include "common/bus/bus_factory.hpp"
#include "common/bus/system_now.hpp"

namespace {

using namespace limbcast;  // NOLINT: a main file
using sensing::MargSample;

struct Options {
  bus::BusConfig bus;
  int rate_hz = 100;
  int burst = 15;
  int seconds = 5;
};

Options Parse(int argc, char** argv) {
  Options options;
  options.bus.domain_id = static_cast<std::uint32_t>(getpid()) % 102;
  options.bus.vendor = argc > 1 ? bus::ParseVendor(argv[1]).value() : bus::Vendor::kCyclone;
  options.rate_hz = argc > 2 ? std::atoi(argv[2]) : options.rate_hz;
  options.burst = argc > 3 ? std::atoi(argv[3]) : options.burst;
  options.seconds = argc > 4 ? std::atoi(argv[4]) : options.seconds;
  options.bus.write_batching = argc > 5 && std::string(argv[5]) == "batching";
  return options;
}

double CpuSeconds() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  const auto seconds = [](const timeval& t) {
    return static_cast<double>(t.tv_sec) + 1e-6 * static_cast<double>(t.tv_usec);
  };
  return seconds(usage.ru_utime) + seconds(usage.ru_stime);
}

int Write(const Options& options) {
  const auto bus = bus::Open(options.bus);
  const auto writer = (*bus)->MakeWriter<MargSample>();
  while ((*writer)->counters().matched == 0) {
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
  std::this_thread::sleep_for(std::chrono::milliseconds(500));  // the reader's side matches too
  const double cpu_before = CpuSeconds();
  const auto period = std::chrono::nanoseconds(1'000'000'000 / options.rate_hz);
  auto next = std::chrono::steady_clock::now();
  const int bursts = options.rate_hz * options.seconds;
  MargSample sample;
  for (int i = 0; i < bursts; ++i) {
    std::this_thread::sleep_until(next += period);
    for (int limb = 0; limb < options.burst; ++limb) {
      sample.sensor_uid = {static_cast<std::uint64_t>(limb) + 1};
      sample.sequence = static_cast<std::uint32_t>(i) + 1;
      sample.published_at = bus::SystemNow();
      if (const Status written = (*writer)->Write(sample); !written) {
        std::fprintf(stderr, "%s\n", written.error().message.c_str());
      }
    }
    (*writer)->Flush();
  }
  const double cpu = CpuSeconds() - cpu_before;
  std::printf("writer: %d samples, %.2f us CPU per sample\n", bursts * options.burst,
              1e6 * cpu / bursts / options.burst);
  std::fflush(stdout);
  while ((*writer)->counters().matched > 0) {
    std::this_thread::sleep_for(std::chrono::milliseconds(5));
  }
  return 0;
}

int Read(const Options& options, pid_t child) {
  const auto expected = static_cast<std::size_t>(options.rate_hz) *
                        static_cast<std::size_t>(options.burst) *
                        static_cast<std::size_t>(options.seconds);
  std::vector<std::int64_t> latencies_ns;
  latencies_ns.reserve(expected);
  std::atomic<std::size_t> count{0};
  double cpu_before = 0.0;
  auto bus = bus::Open(options.bus);
  if (!bus) {
    std::fprintf(stderr, "%s\n", bus.error().message.c_str());
    return 1;
  }
  auto reader = (*bus)->MakeReader<MargSample>(
      {.on_sample =
           [&](const MargSample& sample, const bus::SampleInfo& info) {
             if (count == 0) {
               cpu_before = CpuSeconds();
             }
             if (latencies_ns.size() < expected) {
               latencies_ns.push_back((info.received_at - sample.published_at).count());
             }
             ++count;
           },
       .on_disposed = {}});
  const auto give_up =
      std::chrono::steady_clock::now() + std::chrono::seconds(options.seconds + 10);
  while (count < expected && std::chrono::steady_clock::now() < give_up) {
    std::this_thread::sleep_for(std::chrono::milliseconds(5));
  }
  const double cpu = CpuSeconds() - cpu_before;
  const bus::EndpointCounters counters = (*reader)->counters();
  std::move(reader).value().reset();
  std::move(bus).value().reset();
  waitpid(child, nullptr, 0);
  if (latencies_ns.empty()) {
    std::fprintf(stderr, "nothing was heard\n");
    return 1;
  }
  std::sort(latencies_ns.begin(), latencies_ns.end());
  const auto quantile_us = [&](double q) {
    return 1e-3 * static_cast<double>(latencies_ns[static_cast<std::size_t>(
                      q * static_cast<double>(latencies_ns.size() - 1))]);
  };
  std::printf("reader: %zu of %zu samples, lost %llu, %.2f us CPU per sample\n", count.load(),
              expected, static_cast<unsigned long long>(counters.lost),
              1e6 * cpu / static_cast<double>(count.load()));
  std::printf("one way: p50 %.0f us, p99 %.0f us, p99.9 %.0f us, max %.0f us\n", quantile_us(0.5),
              quantile_us(0.99), quantile_us(0.999), quantile_us(1.0));
  return count == expected ? 0 : 1;
}

}  // namespace

int main(int argc, char** argv) {
  const Options options = Parse(argc, argv);
  const pid_t child = fork();  // before either side has a thread
  return child == 0 ? Write(options) : Read(options, child);
}
