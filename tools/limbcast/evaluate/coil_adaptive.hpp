#pragma once

#include <cstdint>
#include <span>
#include <string>

#include <nlohmann/json_fwd.hpp>

#include "tools/limbcast/evaluate/coil_experiments.hpp"
#include "tools/limbcast/evaluate/coil_trial.hpp"

namespace limbcast::tool {

/// One way to pulse: RMS errors forward, and what it cost.
struct CoilPulsing {
  double position_m = 0.0;
  double orientation_rad = 0.0;
  double duty = 0.0;     ///< part of the scored time in which a coil was on
  double tracked = 0.0;  ///< part of the scored time in which the filter was valid
};

/// Pulses by plan of the filter (filters::CoilPulsePlanner), beside the usual train and a train
/// that is as seldom as the plan turned out to be.
struct CoilAdaptiveResult {
  std::string experiment;
  CoilNoise noise = CoilNoise::kThesis;
  CoilPulsing usual;
  CoilPulsing planned;
  CoilPulsing seldom;
};

/// A sensor that rests and moves by turns, near the source and far from it: what adaptive pulsing
/// is for. 90 s.
[[nodiscard]] CoilExperiment MakeRestingExperiment();

/// Simulates the same motion and errors three times and scores from 5 s on.
[[nodiscard]] CoilAdaptiveResult EvaluateAdaptive(const CoilExperiment& experiment, CoilNoise noise,
                                                  std::uint64_t seed);

[[nodiscard]] std::string AdaptiveTable(std::span<const CoilAdaptiveResult> results);
[[nodiscard]] nlohmann::json AdaptiveJson(std::span<const CoilAdaptiveResult> results,
                                          std::uint64_t seed);

}  // namespace limbcast::tool
