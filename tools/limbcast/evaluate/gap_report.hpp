#pragma once

#include <nlohmann/json.hpp>
#include <span>
#include <string>
#include <vector>

#include "tools/limbcast/evaluate/gap_trial.hpp"

namespace limbcast::tool {

/// Mean over trials, each with equal weight, of one length of gaps or one ratio.
[[nodiscard]] GapResult MeanOfGaps(std::span<const GapResult> results, double gap_s, int ratio);

/// Tables for a terminal, millimetres: a row for each trial, the mean, and beside it what a plain
/// implementation of the specification reaches, the goal (half of that) and the published figures.
///
/// @param settings  changed ones, key=value.
[[nodiscard]] std::string GapTable(std::span<const GapResult> results,
                                   std::span<const std::string> settings);
/// The same figures in metres, with the rule by which gaps are placed.
[[nodiscard]] nlohmann::json GapJson(std::span<const GapResult> results,
                                     std::span<const std::string> settings);

}  // namespace limbcast::tool
