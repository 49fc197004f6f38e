#pragma once

#include <nlohmann/json.hpp>
#include <span>
#include <string>

#include "tools/limbcast/evaluate/coil_endurance.hpp"
#include "tools/limbcast/evaluate/coil_experiments.hpp"
#include "tools/limbcast/evaluate/coil_trial.hpp"

namespace limbcast::tool {

/// Tables for a terminal: a row for each experiment; of each method the 3-D position error and the
/// distance error in mm and the orientation error in degrees (RMS), beside what was published of an
/// experiment of the same name; last the number of repetitions, and the standard deviation of 3-D
/// position between them, forward and smoothed.
[[nodiscard]] std::string CoilTable(std::span<const CoilExperiment> experiments,
                                    std::span<const CoilResult> results);
/// Position and distance in metres, orientation in radians.
[[nodiscard]] nlohmann::json FigureJson(const CoilFigure& figure);
/// The same figures in metres and radians.
[[nodiscard]] nlohmann::json CoilJson(std::span<const CoilExperiment> experiments,
                                      std::span<const CoilResult> results, std::uint64_t seed);

/// Two lines for a terminal.
[[nodiscard]] std::string EnduranceText(const std::string& what, const CoilEndurance& endurance);
[[nodiscard]] nlohmann::json EnduranceJson(const CoilEndurance& endurance);

}  // namespace limbcast::tool
