#pragma once

#include <cstdint>
#include <string>

#include "common/base/result.hpp"
#include "tools/limbcast/bench/churn_report.hpp"
#include "tools/limbcast/demo/demo_options.hpp"

namespace limbcast::tool {

struct ChurnOptions {
  DemoDds dds = DemoDds::kCyclone;
  bus::BusConfig bus;   ///< of the client
  std::string folder;   ///< where the executables are
  double minutes = 10;  ///< range: [0.1, 10000]
  /// Everybody comes, everybody goes, and what is left is counted. Range: [5, 3600]
  double count_every_s = 60.0;
  double action_every_s = 1.0;  ///< mean time between events. Range: [0.05, 60]
  int people = 4;               ///< who come and go. Range: [1, 32]
  std::uint64_t seed = 1;       ///< of who does what when
  ChurnLimits limits;
};

/// A session host, fusion, posture and one spectator; people with a gateway each who join, leave or
/// vanish at random, spectators who come and go, services that are killed at random and started
/// again. Every `count_every_s` everybody comes in and then goes home, and what the processes then
/// still hold is compared with the first time. Prints the table as it grows; gives ChurnJson.
///
/// Fails when the processes do not come up. Ends early, with what is there, on SIGINT and SIGTERM.
[[nodiscard]] Result<nlohmann::json> BenchChurn(const ChurnOptions& options);

}  // namespace limbcast::tool
