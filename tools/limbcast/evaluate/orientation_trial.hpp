#pragma once

#include <Eigen/Geometry>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "common/base/result.hpp"
#include "common/base/verdict.hpp"
#include "common/filters/filter.hpp"
#include "services/gateway/drivers/replay/recording.hpp"
#include "tools/limbcast/evaluate/orientation_metric.hpp"

namespace limbcast::tool {

/// The samples of one sensor of a recording with what is known of the truth, row by row.
struct OrientationTrial {
  std::string name;  ///< of the recording; with several sensors "<recording>.<sensor>"
  std::vector<sensing::MargSample> samples;
  std::vector<Eigen::Quaterniond> q_reference;  ///< identity where the truth is not known
  std::vector<std::uint8_t> known;              ///< 1: the truth is known
  std::vector<std::uint8_t>
      scored;  ///< 1: truth known, and a motion phase if the recording says so
};

/// One trial for each sensor of `recording` that has samples and some truth.
[[nodiscard]] std::vector<OrientationTrial> TrialsOf(const gateway::Recording& recording,
                                                     const std::string& name);

/// Which mean a trial of BROAD counts in, by its name.
enum class TrialGroup { kUndisturbed, kDisturbed, kOther };
[[nodiscard]] TrialGroup GroupOf(const std::string& trial_name);

/// Error of one moment, for plots.
struct ErrorPoint {
  double time_s = 0.0;
  double total_deg = 0.0;
  double heading_deg = 0.0;
  double inclination_deg = 0.0;
  double sigma_deg = 0.0;  ///< √trace of the reported covariance
  bool scored = false;
  bool known = true;  ///< false: nothing to compare with, the errors mean nothing
};

/// What a filter made of a trial.
struct OrientationResult {
  std::string trial;
  TrialGroup group = TrialGroup::kOther;
  std::string filter;
  ErrorStatistics errors;
  VerdictCounters verdicts;
  double mean_nees = 0.0;  ///< mean of eᵀP⁻¹e over the scored rows after the start; 3 is right
  std::uint64_t disturbed_rows = 0;
  double samples_per_s = 0.0;                      ///< of wall time, filter only
  std::vector<Eigen::Quaterniond> q_earth_sensor;  ///< one for each sample, w ≥ 0
  std::vector<ErrorPoint> points;                  ///< at most a few hundred, over the trial
};

/// Runs `filter` over the trial from its first sample. Rows before the filter has started hold its
/// running start, or the identity before the first usable reading.
[[nodiscard]] OrientationResult EvaluateTrial(const OrientationTrial& trial,
                                              filters::OrientationFilter& filter);

}  // namespace limbcast::tool
