#pragma once

#include <cstdint>
#include <map>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

namespace limbcast::tool {

/// What must hold for so many people to be carried.
struct UsersLimits {
  double p99_ms = 20.0;  ///< sensor → client
};

/// One run with `people` people.
struct UsersRun {
  int people = 0;
  std::string refused;  ///< why the pipeline did not come up; "" = it did
  bool clean_exit = false;
  std::uint64_t samples = 0;
  std::uint64_t samples_lost = 0;  ///< between gateway and filter, or refused
  std::uint64_t skeletons = 0;
  std::uint64_t skeletons_lost = 0;  ///< between posture and client
  std::uint64_t incomplete = 0;      ///< skeletons that did not wait for every segment
  double rate_hz = 0.0;              ///< skeletons a second of each person
  double p50_ms = 0.0;
  double p99_ms = 0.0;
  std::map<std::string, double> cores;    ///< busy, by process: gateway, fusion, posture, client
  std::map<std::string, double> rss_mib;  ///< by process
  double host_cores = 0.0;                ///< busy on the whole host, ours included
  double stolen_cores = 0.0;              ///< that this (virtual) machine was not given

  /// Busy with other things than this pipeline.
  [[nodiscard]] double other_cores() const;
};

/// From the summary of `limbcast demo` (demo_summary.hpp).
[[nodiscard]] UsersRun RunOf(int people, const nlohmann::json& summary);

/// "" when all that was sent arrived in time; else what did not hold, with value and limit.
[[nodiscard]] std::string Complaint(const UsersRun& run, const UsersLimits& limits);

/// One line of the table; the heading above it.
[[nodiscard]] std::string RowHeading();
[[nodiscard]] std::string Row(const UsersRun& run, const UsersLimits& limits);

/// All of it: largest number of people that held, runs, cost and memory for each person from a
/// straight line through the runs that held.
[[nodiscard]] nlohmann::json ReportJson(const std::string& dds, const UsersLimits& limits,
                                        const std::vector<UsersRun>& runs);

/// The end of the table, from ReportJson.
[[nodiscard]] std::string ReportText(const nlohmann::json& report);

}  // namespace limbcast::tool
