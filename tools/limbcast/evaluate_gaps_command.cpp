#include "tools/limbcast/evaluate_gaps_command.hpp"

#include <fmt/format.h>

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "services/gateway/drivers/replay/recording_reader.hpp"
#include "tools/limbcast/evaluate/gap_report.hpp"
#include "tools/limbcast/evaluate/parallel.hpp"
#include "tools/limbcast/evaluate/recordings.hpp"
#include "tools/limbcast/position_settings.hpp"
#include "tools/limbcast/report/report_text.hpp"

namespace limbcast::tool {
namespace {

struct GapOptions {
  std::string data;
  std::vector<double> gaps_s;
  std::vector<int> ratios;
  std::vector<std::string> settings;
  std::string json;
};

constexpr const char* kCommand = "limbcast evaluate gaps";

int EvaluateGapsIn(const GapOptions& options) {
  const auto config = PositionConfigFrom(options.settings);
  if (!config) {
    return Refuse(kCommand, config.error());
  }
  if (options.gaps_s.empty() && options.ratios.empty()) {
    return Refuse(kCommand,
                  {ErrorCode::kInvalidArgument, "--gap or --ratio is missing, e.g. --gap 0.5,2"});
  }
  const auto files = RecordingsIn(options.data);
  if (!files) {
    return Refuse(kCommand, files.error());
  }
  std::vector<GapResult> results;
  for (const std::filesystem::path& file : *files) {
    const auto recording = gateway::ReadRecording(file);
    if (!recording) {
      return Refuse(kCommand, recording.error());
    }
    const auto trial = GapTrialOf(*recording, file.stem().string());
    if (!trial) {
      return Refuse(kCommand,
                    {ErrorCode::kCorruptData,
                     file.string() + " has no samples with a known position to compare with"});
    }
    const std::size_t gaps = options.gaps_s.size();
    std::vector<GapResult> of_trial(gaps + options.ratios.size());
    ForEachIndex(of_trial.size(), [&](std::size_t i) {
      of_trial[i] = i < gaps ? EvaluateGaps(*config, *trial, options.gaps_s[i])
                             : EvaluateRatio(*config, *trial, options.ratios[i - gaps]);
    });
    results.insert(results.end(), of_trial.begin(), of_trial.end());
  }
  fmt::print("{}", GapTable(results, options.settings));
  if (!options.json.empty()) {
    if (Status saved = SaveText(options.json, GapJson(results, options.settings).dump(2) + "\n");
        !saved) {
      return Refuse(kCommand, saved.error());
    }
  }
  return 0;
}

}  // namespace

SubCommand AddEvaluateGaps(CLI::App& evaluate) {
  auto options = std::make_shared<GapOptions>();
  CLI::App* app = evaluate.add_subcommand(
      "gaps",
      "Errors of positions in gaps of the optical marker: forward, fixed lag, smoothed, "
      "spline.\nExample:\n  limbcast evaluate gaps --data ../shared/data/broad --gap 0.1,0.5,2 "
      "--json /tmp/gaps.json");
  app->add_option("--data", options->data, "A recording, or a folder of recordings")->required();
  app->add_option("--gap", options->gaps_s, "Lengths of gaps in seconds, separated by commas")
      ->delimiter(',')
      ->check(CLI::Range(0.001, 60.0));
  app->add_option("--ratio", options->ratios,
                  "Inertial samples for each marker, separated by commas")
      ->delimiter(',')
      ->check(CLI::Range(1, 10000));
  app->add_option("--set", options->settings, "key=value of the position filter")
      ->multi_option_policy(CLI::MultiOptionPolicy::TakeAll);
  app->add_option("--json", options->json, "File for the figures");
  return {.app = app, .run = [options] { return EvaluateGapsIn(*options); }};
}

}  // namespace limbcast::tool
