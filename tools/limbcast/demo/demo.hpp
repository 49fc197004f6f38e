#pragma once

#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "common/base/result.hpp"
#include "common/bus/bus.hpp"
#include "common/runtime/host_usage.hpp"
#include "common/runtime/stop_signal.hpp"
#include "common/runtime/system_clock.hpp"
#include "tools/limbcast/demo/demo_options.hpp"
#include "tools/limbcast/demo/demo_summary.hpp"
#include "tools/limbcast/demo/pipeline_processes.hpp"
#include "tools/limbcast/demo/reference_pose.hpp"
#include "tools/limbcast/monitor/pipeline_view.hpp"

namespace limbcast::tool {

/// One run of the pipeline in processes of its own: start, watch, end, sum up. Prints its progress
/// and the summary on stdout. Ends by Ctrl-C, after options.seconds, or with the recording.
class Demo {
 public:
  /// `options` outlive it.
  explicit Demo(const DemoOptions& options) : options_(options), processes_(options) {}

  /// The summary (demo_summary.hpp), or why there is none: a process that does not start, a way
  /// that does not open. No child is left either way.
  [[nodiscard]] Result<nlohmann::json> Run();

  /// Somebody asked this process to stop.
  [[nodiscard]] bool stopped() const { return stop_signal_.Requested(); }

 private:
  [[nodiscard]] Status Begin();
  /// Looks after the children until `done` says so. kTimeout with `what` after `patience`.
  template <typename Done>
  [[nodiscard]] Status Await(Duration patience, const std::string& what, Done&& done);
  [[nodiscard]] Status Watch();
  void BeginToMeasure(Time now);
  void AskReferencePose(Time now);
  void CountErrorsFromWhenItFits();
  void ShowProgress(Time now);
  void End();
  [[nodiscard]] nlohmann::json SumUp();

  const DemoOptions& options_;
  const runtime::SystemClock clock_;
  const runtime::StopSignal stop_signal_;
  PipelineProcesses processes_;
  std::unique_ptr<bus::Bus> bus_;
  std::unique_ptr<PipelineView> view_;
  std::unique_ptr<ReferencePose> reference_pose_;
  Time started_at_{};
  Time measured_from_{};
  Time ended_at_{};
  double client_cpu_at_start_s_ = 0.0;
  runtime::HostUsage host_at_start_;
  runtime::HostUsage host_used_;
  double client_cpu_seconds_ = 0.0;
  bool counting_errors_ = false;
  Time next_progress_{};
  bool ended_cleanly_ = false;
  std::vector<std::string> without_last_report_;
};

}  // namespace limbcast::tool
