#pragma once

#include <string>
#include <vector>

#include "common/base/result.hpp"
#include "tools/limbcast/bench/users_report.hpp"
#include "tools/limbcast/demo/demo_options.hpp"

namespace limbcast::tool {

struct UsersBenchOptions {
  DemoOptions demo;  ///< network, folder, settings; the rest is set here
  UsersLimits limits;
  double seconds = 10.0;  ///< measured in each run, after everybody stood, was aligned and settled
  int attempts = 2;       ///< of each number of people, before it counts as too many
  int first = 1;
  int max = 256;
  std::vector<int> people;  ///< these numbers and no search, when not empty
};

/// What the demo is told for `people` people.
[[nodiscard]] DemoOptions DemoFor(const UsersBenchOptions& options, int people);

/// Runs and prints the table as it grows; gives ReportJson. Fails when not even the first run came
/// to its end. Ends early, with what is there, on SIGINT and SIGTERM.
[[nodiscard]] Result<nlohmann::json> BenchUsers(const UsersBenchOptions& options);

}  // namespace limbcast::tool
