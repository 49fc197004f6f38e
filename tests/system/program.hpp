#pragma once

#include <chrono>
#include <cstdint>
#include <nlohmann/json.hpp>
#include <set>
#include <string>
#include <vector>

#include "common/base/time.hpp"
#include "tests/support/temporary_folder.hpp"
#include "tools/process/child_process.hpp"

namespace limbcast::test_support {

/// Path of one of our executables: Program("limbcast-fusion").
[[nodiscard]] std::string Program(const std::string& name);

/// How a program that was run to its end has ended.
struct Outcome {
  bool started = false;
  bool timed_out = false;  ///< it was killed after the deadline
  int status = -1;
  int signal = 0;
  std::string output;
  std::string errors;
};
/// For messages of failed assertions.
[[nodiscard]] std::string Describe(const Outcome& outcome);

[[nodiscard]] Outcome RunToEnd(const std::vector<std::string>& arguments,
                               Duration deadline = std::chrono::seconds(10));

/// A DDS domain in [0, 101] that nothing on this host uses, another one for each call.
[[nodiscard]] std::uint32_t OwnDomain();

/// Processes alive now in this network of which an argument list contains `--domain
/// <domain>`.
[[nodiscard]] std::vector<pid_t> ProcessesOnDomain(std::uint32_t domain);
/// The one of these whose executable is `name`, or 0.
[[nodiscard]] pid_t ProcessOnDomain(std::uint32_t domain, const std::string& name);

/// Names in /dev/shm.
[[nodiscard]] std::set<std::string> SharedMemoryFiles();

/// Waits, looking every few milliseconds, until `condition` holds; false after `deadline`.
template <typename Condition>
[[nodiscard]] bool Eventually(Duration deadline, Condition condition) {
  const auto end = std::chrono::steady_clock::now() + deadline;
  while (!condition()) {
    if (std::chrono::steady_clock::now() > end) {
      return false;
    }
    timespec pause{0, 5'000'000};
    nanosleep(&pause, nullptr);
  }
  return true;
}

using test_support::TemporaryFolder;

/// `limbcast demo` run to its end on a domain of its own.
struct DemoRun {
  Outcome outcome;
  nlohmann::json summary;  ///< null when there is none
  std::size_t processes_left = 0;
  std::set<std::string> shared_memory_left;
};
[[nodiscard]] DemoRun RunDemo(std::vector<std::string> arguments, Duration deadline);

/// published = filtered + refused + lost, as numbers of a demo's summary.
struct Balance {
  std::uint64_t published = 0;
  std::uint64_t filtered = 0;
  std::uint64_t refused = 0;
  std::uint64_t lost = 0;
};
[[nodiscard]] Balance BalanceOf(const nlohmann::json& summary);

}  // namespace limbcast::test_support
