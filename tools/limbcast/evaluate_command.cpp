#include "tools/limbcast/evaluate_command.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "common/filters/filter_batches.hpp"
#include "common/filters/filter_factory.hpp"
#include "services/gateway/drivers/replay/recording_reader.hpp"
#include "tools/limbcast/evaluate/orientation_report.hpp"
#include "tools/limbcast/evaluate/orientation_trial.hpp"
#include "tools/limbcast/evaluate/progress_bar.hpp"
#include "tools/limbcast/evaluate/recordings.hpp"
#include "tools/limbcast/evaluate_body_command.hpp"
#include "tools/limbcast/evaluate_coil_command.hpp"
#include "tools/limbcast/evaluate_gaps_command.hpp"
#include "tools/limbcast/evaluate_published_command.hpp"
#include "tools/limbcast/report/report_text.hpp"

namespace limbcast::tool {
namespace {

struct EvaluateOptions {
  std::string data;
  std::vector<std::string> filters = {"bmf"};
  std::vector<std::string> settings;
  std::string out;
  std::string json;
};

constexpr const char* kCommand = "limbcast evaluate";

// "key=value" is for every filter, "filter.key=value" for one.
Result<std::vector<filters::Setting>> SettingsFor(const std::string& filter,
                                                  const std::vector<std::string>& texts) {
  std::vector<filters::Setting> settings;
  for (const std::string& text : texts) {
    const std::size_t equals = text.find('=');
    if (equals == std::string::npos || equals == 0) {
      return Error{ErrorCode::kInvalidArgument,
                   "--set must be key=value or filter.key=value, is '" + text + "'"};
    }
    std::string key = text.substr(0, equals);
    if (const std::size_t dot = key.find('.'); dot != std::string::npos) {
      if (key.substr(0, dot) != filter) {
        continue;
      }
      key = key.substr(dot + 1);
    }
    settings.emplace_back(std::move(key), text.substr(equals + 1));
  }
  return settings;
}

// A filter's own settings must be of a filter that runs: a slip of the pen is no wish.
Status CheckOwners(const EvaluateOptions& options) {
  for (const std::string& text : options.settings) {
    const std::string key = text.substr(0, text.find('='));
    const std::size_t dot = key.find('.');
    const std::string owner = key.substr(0, dot);
    if (dot != std::string::npos &&
        std::find(options.filters.begin(), options.filters.end(), owner) == options.filters.end()) {
      return Error{ErrorCode::kInvalidArgument,
                   fmt::format("--set {}: the filters are {}, none is '{}'", text,
                               fmt::join(options.filters, ", "), owner)};
    }
  }
  return Ok();
}

// Before anything is computed: a folder that cannot be written to is known at once.
Status MakeFolder(const std::string& folder) {
  std::error_code failed;
  if (!folder.empty() && !std::filesystem::is_directory(folder, failed) &&
      !std::filesystem::create_directories(folder, failed)) {
    return Error{ErrorCode::kUnavailable,
                 "--out " + folder + " cannot be made: " + failed.message()};
  }
  return Ok();
}

struct PreparedFilter {
  std::string name;
  std::vector<filters::Setting> settings;
};

Result<std::vector<PreparedFilter>> PrepareFilters(const EvaluateOptions& options) {
  std::vector<PreparedFilter> prepared;
  if (const Status checked = CheckOwners(options); !checked) {
    return checked.error();
  }
  for (const std::string& name : options.filters) {
    auto settings = SettingsFor(name, options.settings);
    if (!settings) {
      return settings.error();
    }
    if (auto made = filters::MakeFilter(name, *settings); !made) {
      return made.error();
    }
    prepared.push_back({name, std::move(*settings)});
  }
  return prepared;
}

Status SaveResults(const EvaluateOptions& options, const ReportHead& head,
                   const std::vector<OrientationResult>& results) {
  if (!options.out.empty()) {
    const std::filesystem::path out = options.out;
    for (const OrientationResult& result : results) {
      if (Status saved =
              SaveQuaternions(out / result.filter / (result.trial + ".csv"), result.q_earth_sensor);
          !saved) {
        return saved;
      }
    }
    if (Status saved = SaveText(out / "report.html", OrientationHtml(head, results)); !saved) {
      return saved;
    }
  }
  if (!options.json.empty()) {
    return SaveText(options.json, OrientationJson(head, results).dump(2) + "\n");
  }
  return Ok();
}

int EvaluateOrientation(const EvaluateOptions& options) {
  const auto prepared = PrepareFilters(options);
  if (!prepared) {
    return Refuse(kCommand, prepared.error());
  }
  const auto files = RecordingsIn(options.data);
  if (!files) {
    return Refuse(kCommand, files.error());
  }
  if (const Status made = MakeFolder(options.out); !made) {
    return Refuse(kCommand, made.error());
  }
  std::vector<OrientationResult> results;
  const std::size_t all = files->size() * prepared->size();
  std::size_t done = 0;
  for (const std::filesystem::path& file : *files) {
    const auto recording = gateway::ReadRecording(file);
    if (!recording) {
      return Refuse(kCommand, recording.error());
    }
    const auto trials = TrialsOf(*recording, file.stem().string());
    if (trials.empty()) {
      return Refuse(kCommand,
                    {ErrorCode::kCorruptData,
                     file.string() + " has no samples with a known orientation to compare with"});
    }
    for (const PreparedFilter& filter : *prepared) {
      ShowProgress(done, all, file.stem().string() + " " + filter.name);
      for (const OrientationTrial& trial : trials) {
        // Seated as in the fusion service: lanes add in another order than a filter alone, and the
        // last digit is to be the same.
        auto made = filters::MakeFilter(filter.name, filter.settings);
        const auto seated = filters::FilterBatches().Seat(std::move(*made));
        results.push_back(EvaluateTrial(trial, *seated));
      }
      ++done;
    }
  }
  ShowProgress(done, all, "");
  const ReportHead head{.filters = options.filters, .settings = options.settings};
  fmt::print("{}", OrientationTable(head, results));
  if (Status saved = SaveResults(options, head, results); !saved) {
    return Refuse(kCommand, saved.error());
  }
  return 0;
}

}  // namespace

SubCommand AddEvaluateCommand(service::ServiceCommandLine& line) {
  auto options = std::make_shared<EvaluateOptions>();
  CLI::App* evaluate =
      line.app().add_subcommand("evaluate", "Compare filters with the truth of recordings");
  evaluate->require_subcommand(1);
  evaluate->fallthrough();
  CLI::App* app = evaluate->add_subcommand(
      "orientation",
      "Orientation errors by the definition of the BROAD benchmark.\nExample:\n  limbcast evaluate "
      "orientation --data ../shared/data/broad --filter tqt,bmf --out /tmp/report");
  app->add_option("--data", options->data, "A recording, or a folder of recordings")->required();
  app->add_option("--filter", options->filters, "Filters, separated by commas")->delimiter(',');
  app->add_option("--set", options->settings, "key=value or filter.key=value")
      ->multi_option_policy(CLI::MultiOptionPolicy::TakeAll);
  app->add_option("--out", options->out,
                  "Folder for <filter>/<trial>.csv (w,x,y,z) and report.html");
  app->add_option("--json", options->json, "File for the figures");
  const SubCommand published = AddEvaluatePublishedCommand(*evaluate);
  const SubCommand gaps = AddEvaluateGaps(*evaluate);
  const SubCommand coil = AddEvaluateCoil(*evaluate);
  const SubCommand body = AddEvaluateBody(*evaluate);
  return {.app = evaluate, .run = [options, published, gaps, coil, body] {
            if (body.app->parsed()) {
              return body.run();
            }
            if (coil.app->parsed()) {
              return coil.run();
            }
            if (published.app->parsed()) {
              return published.run();
            }
            return gaps.app->parsed() ? gaps.run() : EvaluateOrientation(*options);
          }};
}

}  // namespace limbcast::tool
