// Time of the field of one coil with its Jacobian, at places a sensor may be: what an iteration of
// the coil filter and a third of a step of the pose solver pay for it.
#include "common/sensing/coil_field.hpp"

#include <benchmark/benchmark.h>

#include <random>
#include <vector>

namespace limbcast::sensing {
namespace {

// Directions at random, so evenly from 0.1 to 0.8 m.
std::vector<Eigen::Vector3d> Places() {
  std::mt19937 rng(1);
  std::normal_distribution<double> normal;
  std::uniform_real_distribution<double> radius_m(0.1, 0.8);
  std::vector<Eigen::Vector3d> places(1024);
  for (Eigen::Vector3d& p : places) {
    p = radius_m(rng) * Eigen::Vector3d(normal(rng), normal(rng), normal(rng)).normalized();
  }
  return places;
}

void BM_CoilField(benchmark::State& state) {
  const std::vector<Eigen::Vector3d> places = Places();
  const CoilSource source;
  for (auto _ : state) {
    int coil = 0;
    for (const Eigen::Vector3d& p : places) {
      benchmark::DoNotOptimize(CoilField(source, coil, 1.5, p));
      coil = (coil + 1) % 3;
    }
  }
  state.SetItemsProcessed(state.iterations() * static_cast<std::int64_t>(places.size()));
}

BENCHMARK(BM_CoilField)->Unit(benchmark::kMicrosecond);

}  // namespace
}  // namespace limbcast::sensing
