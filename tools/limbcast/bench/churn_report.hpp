#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "tools/process/process_count.hpp"

namespace limbcast::tool {

/// What is left when everybody has gone home, once in a while.
struct ChurnCount {
  double at_s = 0.0;         ///< since the begin
  double all_there_s = 0.0;  ///< before, until each person had a skeleton; -1 = not in time
  std::map<std::string, process::ProcessCount> processes;  ///< session, fusion, posture, client
  std::size_t shared_memory_files = 0;
  std::vector<std::string> people;  ///< who is still in the roster or has a body, and which
};

/// What happened meanwhile.
struct ChurnEvents {
  std::uint64_t joined = 0;
  std::uint64_t left = 0;
  std::uint64_t vanished = 0;                   ///< gateways killed
  std::map<std::string, std::uint64_t> killed;  ///< services, each started again at once
  std::uint64_t spectators = 0;                 ///< came and left
  std::vector<std::string> failures;            ///< what crashed, refused, or changed its body id
};

struct ChurnLimits {
  double rss_mib = 8.0;  ///< a process may hold so much more than at the first count
};

/// "" when `now` holds nothing more than `first`; else what, with both values.
[[nodiscard]] std::string LeakOf(const ChurnCount& first, const ChurnCount& now,
                                 const ChurnLimits& limits);

/// One line of the table; the heading above it.
[[nodiscard]] std::string ChurnHeading();
[[nodiscard]] std::string ChurnRow(const ChurnCount& first, const ChurnCount& now,
                                   const ChurnLimits& limits);

/// All of it; `ok` when there was more than one count, nothing leaked and nothing failed.
[[nodiscard]] nlohmann::json ChurnJson(const std::vector<ChurnCount>& counts,
                                       const ChurnEvents& events, const ChurnLimits& limits);

/// The end of the table, from ChurnJson.
[[nodiscard]] std::string ChurnText(const nlohmann::json& report);

}  // namespace limbcast::tool
