#pragma once

#include <array>
#include <cstddef>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "common/base/result.hpp"
#include "tools/limbcast/demo/demo_options.hpp"
#include "tools/process/child_process.hpp"

namespace limbcast::tool {

enum class Part : std::uint8_t { kGateway = 0, kFusion = 1, kPosture = 2 };
inline constexpr std::array<std::string_view, 3> kPartNames = {"gateway", "fusion", "posture"};
[[nodiscard]] inline std::string_view NameOf(Part part) {
  return kPartNames[static_cast<std::size_t>(part)];
}

/// What a demo starts for `part`.
[[nodiscard]] std::vector<std::string> ArgumentsOf(Part part, const DemoOptions& options);

/// The three services as child processes. One that is killed from outside is started again; one
/// that refuses (status other than 0) is a failure. Thread-compatible.
class PipelineProcesses {
 public:
  explicit PipelineProcesses(const DemoOptions& options) : options_(options) {}

  [[nodiscard]] Status Start(Part part);

  /// Looks after the children: starts again what was killed. Fails when a child refused to run.
  [[nodiscard]] Status Supervise();

  /// The gateway came to the end of its recording.
  [[nodiscard]] bool gateway_finished() const { return gateway_finished_; }

  /// Asks `part` to end and waits for it. False when it did not end cleanly.
  bool Stop(Part part);

  [[nodiscard]] std::uint32_t pid(Part part) const;
  [[nodiscard]] const std::map<std::string, int>& restarts() const { return restarts_; }
  /// No child crashed (ended by another signal than someone's kill).
  [[nodiscard]] bool clean() const { return clean_; }
  /// Descendants that are still there after every Stop.
  [[nodiscard]] std::size_t leftovers() const;
  /// CPU time of ended children by name, from the kernel.
  [[nodiscard]] const std::map<std::string, double>& cpu_seconds() const { return cpu_seconds_; }
  /// What the children said on stderr, each line with its name in front.
  [[nodiscard]] std::string Errors() const;

 private:
  struct Child {
    std::optional<process::ChildProcess> process;
  };
  [[nodiscard]] Status Ended(Part part, const process::ExitState& state);
  void Collect(Part part, const process::ExitState& state);

  const DemoOptions& options_;
  std::array<Child, kPartNames.size()> children_;
  std::vector<pid_t> sessions_;
  std::map<std::string, int> restarts_;
  std::map<std::string, double> cpu_seconds_;
  std::string errors_;
  bool gateway_finished_ = false;
  bool clean_ = true;
};

}  // namespace limbcast::tool
