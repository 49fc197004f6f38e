#include "tools/limbcast/evaluate/coil_repetitions.hpp"

#include <array>
#include <cmath>
#include <mutex>

#include "common/base/expects.hpp"
#include "common/simulation/random.hpp"
#include "tools/limbcast/evaluate/parallel.hpp"

namespace limbcast::tool {
namespace {

constexpr std::array kValues = {&CoilFigure::position_m, &CoilFigure::distance_m,
                                &CoilFigure::orientation_rad};

void AddShare(CoilTracking& mean, const CoilTracking& one, double share) {
  mean.tracked += share * one.tracked;
  mean.nees += share * one.nees;
  mean.losses += one.losses;
}

}  // namespace

std::uint64_t RepetitionSeed(std::uint64_t seed, int repetition) {
  return repetition == 0
             ? seed
             : simulation::Random(seed, "repetition " + std::to_string(repetition)).Next();
}

CoilResult MeanOf(std::span<const CoilResult> repetitions) {
  Expects(!repetitions.empty(), "at least one repetition");
  CoilResult mean;
  mean.experiment = repetitions.front().experiment;
  mean.noise = repetitions.front().noise;
  mean.repetitions = static_cast<int>(repetitions.size());
  const double share = 1.0 / static_cast<double>(repetitions.size());
  for (const CoilResult& one : repetitions) {
    mean.mean_range_m += share * one.mean_range_m;
    AddShare(mean.forward, one.forward, share);
    AddShare(mean.loose, one.loose, share);
    for (std::size_t method = 0; method < kCoilMethodCount; ++method) {
      mean.figures[method].count += one.figures[method].count;
      for (const auto value : kValues) {
        mean.figures[method].*value += share * one.figures[method].*value;
      }
    }
  }
  if (repetitions.size() < 2) {
    return mean;
  }
  const double of_spread = 1.0 / static_cast<double>(repetitions.size() - 1);
  for (std::size_t method = 0; method < kCoilMethodCount; ++method) {
    for (const auto value : kValues) {
      double variance = 0.0;
      for (const CoilResult& one : repetitions) {
        const double off = one.figures[method].*value - mean.figures[method].*value;
        variance += of_spread * off * off;
      }
      mean.deviations[method].*value = std::sqrt(variance);
    }
  }
  return mean;
}

std::vector<CoilResult> RepeatCoilExperiments(
    const std::string& only, std::uint64_t seed, int repetitions,
    const std::function<void(std::size_t done, std::size_t all)>& on_done) {
  Expects(repetitions >= 1, "at least one repetition");
  const std::vector<CoilCase> cases = CoilCasesOf(MakeCoilExperiments(seed), only);
  const auto each = static_cast<std::size_t>(repetitions);
  std::vector<CoilResult> all(each * cases.size());
  std::mutex mutex;
  std::size_t done = 0;
  ForEachIndex(all.size(), [&](std::size_t i) {
    const CoilCase& wanted = cases[i / each];
    const std::uint64_t own_seed = RepetitionSeed(seed, static_cast<int>(i % each));
    const auto experiments = MakeCoilExperiments(own_seed);
    all[i] = EvaluateCoil(experiments[wanted.experiment], wanted.noise, own_seed);
    const std::scoped_lock lock(mutex);
    ++done;
    if (on_done) {
      on_done(done, all.size());
    }
  });
  std::vector<CoilResult> means;
  for (std::size_t first = 0; first < all.size(); first += each) {
    means.push_back(MeanOf(std::span(all).subspan(first, each)));
  }
  return means;
}

}  // namespace limbcast::tool
