#include "tools/limbcast/evaluate/coil_states.hpp"

#include <fmt/format.h>

#include <nlohmann/json.hpp>
#include <numbers>

#include "tools/limbcast/evaluate/coil_repetitions.hpp"

namespace limbcast::tool {
namespace {

constexpr double kMmPerM = 1e3;
constexpr double kDegPerRad = 180.0 / std::numbers::pi;

CoilTrial MakeTrial(const CoilExperiment& experiment, CoilNoise noise, CoilStates states,
                    std::uint64_t seed) {
  simulation::CoilStreamConfig stream = MakeCoilStream(experiment, noise, seed);
  stream.emitter_magnetometer = states >= CoilStates::kCompass;
  filters::CoilInertialConfig filter = MakeCoilFilter(experiment, noise);
  filter.source = stream.source;
  filter.estimate_calibration = states >= CoilStates::kCalibration;
  filter.estimate_gyro_delay = filter.estimate_calibration;
  filter.estimate_gradient = states >= CoilStates::kGradient;
  return MakeCoilTrial(experiment, noise, stream, filter, seed);
}

}  // namespace

CoilStatesResult EvaluateCoilStates(std::size_t experiment, CoilNoise noise, std::uint64_t seed,
                                    int repetitions) {
  CoilStatesResult result;
  result.noise = noise;
  result.repetitions = repetitions;
  const double share = 1.0 / repetitions;
  for (int r = 0; r < repetitions; ++r) {
    const std::uint64_t own_seed = RepetitionSeed(seed, r);
    const CoilExperiment drawn = MakeCoilExperiments(own_seed).at(experiment);
    result.experiment = drawn.name;
    for (std::size_t i = 0; i < kCoilStatesCount; ++i) {
      const CoilFollowed followed =
          FollowTrial(MakeTrial(drawn, noise, static_cast<CoilStates>(i), own_seed));
      CoilStatesResult::Figures& mean = result.figures[i];
      mean.forward_m += share * followed.live.forward.position_m;
      mean.forward_rad += share * followed.live.forward.orientation_rad;
      mean.smoothed_m += share * followed.smoothed.position_m;
      mean.nees += share * followed.live.tracking.nees;
    }
  }
  return result;
}

std::string CoilStatesTable(std::span<const CoilStatesResult> results) {
  std::string text =
      "RMS 3-D position forward / smoothed in mm, orientation forward in deg, NEES\n";
  text += fmt::format("{:<20} {:>6}", "experiment", "noise");
  for (const char* name : kCoilStatesNames) {
    text += fmt::format(" | {:^24}", name);
  }
  text += '\n';
  for (const CoilStatesResult& r : results) {
    text += fmt::format("{:<20.20} {:>3.0f} nT", r.experiment, 1e9 * SigmaOf_tesla(r.noise));
    for (const CoilStatesResult::Figures& f : r.figures) {
      text += fmt::format(" | {:>5.1f} / {:>4.1f}  {:>5.2f}  {:>3.1f}", kMmPerM * f.forward_m,
                          kMmPerM * f.smoothed_m, kDegPerRad * f.forward_rad, f.nees);
    }
    text += '\n';
  }
  return text;
}

nlohmann::json CoilStatesJson(std::span<const CoilStatesResult> results, std::uint64_t seed) {
  nlohmann::json json = {{"seed", seed}, {"trials", nlohmann::json::array()}};
  for (const CoilStatesResult& r : results) {
    nlohmann::json trial = {{"experiment", r.experiment},
                            {"sigma_mag_tesla", SigmaOf_tesla(r.noise)},
                            {"repetitions", r.repetitions}};
    for (std::size_t i = 0; i < kCoilStatesCount; ++i) {
      const CoilStatesResult::Figures& f = r.figures[i];
      trial[kCoilStatesNames[i]] = {{"forward_m", f.forward_m},
                                    {"smoothed_m", f.smoothed_m},
                                    {"forward_rad", f.forward_rad},
                                    {"nees_per_axis", f.nees}};
    }
    json["trials"].push_back(std::move(trial));
  }
  return json;
}

}  // namespace limbcast::tool
