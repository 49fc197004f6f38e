#include "tools/limbcast/smooth_command.hpp"

#include <fmt/format.h>

#include <cstdio>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "common/filters/position/offline_smoother.hpp"
#include "common/filters/position/position_series.hpp"
#include "services/gateway/drivers/replay/recording_reader.hpp"
#include "tools/limbcast/evaluate/gap_trial.hpp"
#include "tools/limbcast/evaluate/position_csv.hpp"
#include "tools/limbcast/position_settings.hpp"
#include "tools/limbcast/report/report_text.hpp"

namespace limbcast::tool {
namespace {

struct SmoothOptions {
  std::string recording;
  std::string out;
  std::vector<std::string> settings;
};

constexpr const char* kCommand = "limbcast smooth";

int Smooth(const SmoothOptions& options) {
  const auto config = PositionConfigFrom(options.settings);
  if (!config) {
    return Refuse(kCommand, config.error());
  }
  const auto recording = gateway::ReadRecording(options.recording);
  if (!recording) {
    return Refuse(kCommand, recording.error());
  }
  const auto trial =
      GapTrialOf(*recording, std::filesystem::path(options.recording).stem().string());
  if (!trial) {
    return Refuse(kCommand,
                  {ErrorCode::kCorruptData,
                   options.recording + " has no optical positions beside its inertial samples"});
  }
  const filters::OfflineResult result =
      filters::SmoothOffline(*config, trial->samples, trial->markers);
  std::vector<Time> rows;
  std::vector<filters::SeenMarker> seen;
  for (std::size_t row = 0; row < trial->samples.size(); ++row) {
    rows.push_back(trial->samples[row].measured_at);
    if (trial->markers[row].visible) {
      seen.push_back({trial->markers[row].measured_at, trial->markers[row].p_earth_marker_m});
    }
  }
  const std::string csv = PositionCsv(filters::SeriesAt(result.estimates, rows, seen));
  fmt::print(stderr, "{}", SmoothSummary(result));
  if (options.out.empty()) {
    fmt::print("{}", csv);
    return 0;
  }
  if (Status saved = SaveText(options.out, csv); !saved) {
    return Refuse(kCommand, saved.error());
  }
  return 0;
}

}  // namespace

SubCommand AddSmoothCommand(service::ServiceCommandLine& line) {
  auto options = std::make_shared<SmoothOptions>();
  CLI::App* app = line.app().add_subcommand(
      "smooth",
      "Positions of a recording from its optical marker and its inertial unit, smoothed from both "
      "sides, as CSV.\nExample:\n  limbcast smooth walk.hdf5 --out walk_position.csv --set "
      "sigma_marker_m=0.0005");
  app->add_option("RECORDING", options->recording, "A recording with optical positions")
      ->required();
  app->add_option("--out", options->out, "File for the CSV (default: standard output)");
  app->add_option("--set", options->settings, "key=value of the position filter")
      ->multi_option_policy(CLI::MultiOptionPolicy::TakeAll);
  return {.app = app, .run = [options] { return Smooth(*options); }};
}

}  // namespace limbcast::tool
