#pragma once

#include <cstdint>
#include <functional>
#include <span>
#include <string>
#include <vector>

#include "tools/limbcast/evaluate/coil_trial.hpp"

namespace limbcast::tool {

/// As often as the thesis repeated each of its experiments (Roetenberg 2006, section 6.3).
inline constexpr int kCoilRepetitions = 10;

/// The seed of repetition 0, 1, ...: the first has `seed` itself, others one that comes from it.
[[nodiscard]] std::uint64_t RepetitionSeed(std::uint64_t seed, int repetition);

/// Means of all figures of one experiment's repetitions, and the standard deviations between them.
/// Losses are those of all together.
///
/// @param repetitions  at least one, all of one experiment and noise.
[[nodiscard]] CoilResult MeanOf(std::span<const CoilResult> repetitions);

/// The experiments whose name has `only` in it, at each noise, on all cores. Motions, errors of the
/// sensors, noise and gradient of the room are drawn anew in each repetition (RepetitionSeed).
///
/// @param on_done  called with how many trials are done, and how many there are; by any thread, one
///                 at a time.
[[nodiscard]] std::vector<CoilResult> RepeatCoilExperiments(
    const std::string& only, std::uint64_t seed, int repetitions,
    const std::function<void(std::size_t done, std::size_t all)>& on_done = {});

}  // namespace limbcast::tool
