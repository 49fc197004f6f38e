// Cost of the wire: domain value -> wire type -> CDR and back, for the topics of the hot path.

#include <benchmark/benchmark.h>

#include <array>
#include <random>
#include <vector>

#include "common/bus/wire/codec.hpp"
#include "common/bus/wire/wire_types.hpp"
#include "tests/unit/common/bus/random_values.hpp"

namespace limbcast::bus {
namespace {

template <typename T>
void BM_EncodeAndSerialize(benchmark::State& state) {
  std::mt19937_64 rng(1);
  const T value = testing::RandomValue<T>(rng);
  typename Codec<T>::Wire wire;
  std::array<char, 16384> bytes{};
  std::size_t size = 0;
  for (auto _ : state) {
    benchmark::DoNotOptimize(Codec<T>::Encode(value, wire).ok());
    size = Codec<T>::SerializedSize(wire);
    benchmark::DoNotOptimize(Codec<T>::Serialize(wire, std::span(bytes).first(size)));
  }
  state.SetItemsProcessed(state.iterations());
  state.counters["bytes"] = static_cast<double>(size);
}

template <typename T>
void BM_DeserializeAndDecode(benchmark::State& state) {
  std::mt19937_64 rng(1);
  typename Codec<T>::Wire wire;
  benchmark::DoNotOptimize(Codec<T>::Encode(testing::RandomValue<T>(rng), wire).ok());
  std::vector<char> bytes(Codec<T>::SerializedSize(wire));
  benchmark::DoNotOptimize(Codec<T>::Serialize(wire, bytes));
  T value;
  for (auto _ : state) {
    benchmark::DoNotOptimize(Codec<T>::Deserialize(bytes, wire));
    benchmark::DoNotOptimize(Codec<T>::Decode(wire, value).ok());
  }
  state.SetItemsProcessed(state.iterations());
}

BENCHMARK(BM_EncodeAndSerialize<sensing::MargSample>);
BENCHMARK(BM_DeserializeAndDecode<sensing::MargSample>);
BENCHMARK(BM_EncodeAndSerialize<body::SegmentState>);
BENCHMARK(BM_DeserializeAndDecode<body::SegmentState>);
BENCHMARK(BM_EncodeAndSerialize<body::Skeleton>);
BENCHMARK(BM_DeserializeAndDecode<body::Skeleton>);
BENCHMARK(BM_EncodeAndSerialize<sensing::MargFrame>);
BENCHMARK(BM_DeserializeAndDecode<sensing::MargFrame>);

}  // namespace
}  // namespace limbcast::bus
