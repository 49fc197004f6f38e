#pragma once

#include <map>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "tools/limbcast/demo/demo_options.hpp"
#include "tools/limbcast/monitor/pipeline_model.hpp"

namespace limbcast::tool {

/// What a demo knows beside the model when it ends.
struct DemoOutcome {
  double duration_s = 0.0;
  bool clean_exit = false;
  std::map<std::string, int> restarts;
  std::map<std::string, double> child_cpu_seconds;  ///< of their whole life
  double client_cpu_seconds = 0.0;                  ///< while skeletons came
  double client_rss_mib = 0.0;
  double host_busy_seconds = 0.0;    ///< CPU time of the whole host meanwhile, ours included
  double host_stolen_seconds = 0.0;  ///< CPU time that the host of a virtual machine kept
  /// Processes whose last report did not arrive: the counters lack what came after the one before.
  std::vector<std::string> without_last_report;
  std::string reference_pose;  ///< what the posture service said of it; "" = never asked
};

/// The summary as one object; deploy-independent names, units at the end of the names.
[[nodiscard]] nlohmann::json SummaryJson(const DemoOptions& options, const PipelineModel& model,
                                         const DemoOutcome& outcome);

/// The same for people, some fifteen lines.
[[nodiscard]] std::string SummaryText(const nlohmann::json& summary);

/// One line while it runs.
[[nodiscard]] std::string ProgressLine(const PipelineModel& model, double elapsed_s);

}  // namespace limbcast::tool
