#pragma once

#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "common/base/result.hpp"
#include "tools/limbcast/evaluate/orientation_trial.hpp"

namespace limbcast::tool {

/// Mean over trials of their RMS errors, each trial with equal weight as BROAD does it.
struct OrientationMean {
  std::size_t trials = 0;
  double total_deg = 0.0;
  double heading_deg = 0.0;
  double inclination_deg = 0.0;
  double median_total_deg = 0.0;
};

/// Over the results of one filter; of one group, or of all.
[[nodiscard]] OrientationMean MeanOf(std::span<const OrientationResult> results,
                                     const std::string& filter,
                                     std::optional<TrialGroup> group = std::nullopt);

/// What the filters were told, for the head of a report: "bmf: output_lead_s=0.004".
struct ReportHead {
  std::vector<std::string> filters;   ///< in the order asked for
  std::vector<std::string> settings;  ///< changed ones; empty = the shipped defaults
};

/// The settings that make a filter predict ahead of its samples ("output_lead_s" other than 0): a
/// reader must know it, because other filters are compared without.
[[nodiscard]] std::vector<std::string> OutputLeads(const ReportHead& head);

/// A table for a terminal: a row for each trial and filter, then the means.
[[nodiscard]] std::string OrientationTable(const ReportHead& head,
                                           std::span<const OrientationResult> results);
[[nodiscard]] nlohmann::json OrientationJson(const ReportHead& head,
                                             std::span<const OrientationResult> results);
/// One self-contained page with the table and error-over-time plots.
[[nodiscard]] std::string OrientationHtml(const ReportHead& head,
                                          std::span<const OrientationResult> results);

/// `w,x,y,z` and a row for each sample.
[[nodiscard]] Status SaveQuaternions(const std::filesystem::path& path,
                                     std::span<const Eigen::Quaterniond> q_earth_sensor);

}  // namespace limbcast::tool
