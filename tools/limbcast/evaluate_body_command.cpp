#include "tools/limbcast/evaluate_body_command.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <memory>
#include <string>
#include <vector>

#include "services/gateway/drivers/replay/recording_reader.hpp"
#include "tools/limbcast/person/body_figures.hpp"
#include "tools/limbcast/person/body_html.hpp"
#include "tools/limbcast/person/body_trial.hpp"
#include "tools/limbcast/report/report_text.hpp"

namespace limbcast::tool {
namespace {

struct BodyOptions {
  std::string data;
  std::vector<std::string> sensors;
  std::string filter = "bmf";
  std::string stand;
  std::string sit;
  std::vector<std::string> walks;
  double pose_s = -1.0;
  double until_s = 0.0;
  std::string out;
};

constexpr const char* kCommand = "limbcast evaluate body";

Result<TimeSpan> ParseSpan(const std::string& option, const std::string& text) {
  const std::size_t colon = text.find(':');
  TimeSpan span;
  const auto read = [](const std::string& number, double& into) {
    const auto [end, error] = std::from_chars(number.data(), number.data() + number.size(), into);
    return error == std::errc() && end == number.data() + number.size();
  };
  if (colon == std::string::npos || !read(text.substr(0, colon), span.from_s) ||
      !read(text.substr(colon + 1), span.to_s) || !(span.from_s < span.to_s)) {
    return Error{ErrorCode::kInvalidArgument,
                 fmt::format("{} must be FROM:TO in seconds, is '{}'", option, text)};
  }
  return span;
}

Result<BodyPhases> PhasesOf(const BodyOptions& options) {
  BodyPhases phases;
  const auto optional = [](const char* name, const std::string& text,
                           std::optional<TimeSpan>& into) -> Status {
    if (text.empty()) {
      return Ok();
    }
    const auto span = ParseSpan(name, text);
    if (!span) {
      return span.error();
    }
    into = *span;
    return Ok();
  };
  for (const Status& read : {optional("--stand", options.stand, phases.standing),
                             optional("--sit", options.sit, phases.sitting)}) {
    if (!read) {
      return read.error();
    }
  }
  for (const std::string& text : options.walks) {
    const auto span = ParseSpan("--walk", text);
    if (!span) {
      return span.error();
    }
    phases.walks.push_back(*span);
  }
  return phases;
}

Result<gateway::RecordingOptions> AssignmentsOf(const std::vector<std::string>& texts) {
  gateway::RecordingOptions options;
  for (const std::string& text : texts) {
    const std::size_t equals = text.find('=');
    if (equals == std::string::npos) {
      return Error{ErrorCode::kInvalidArgument, "--sensor must be NAME=segment, is '" + text + "'"};
    }
    options.assignments.push_back({text.substr(0, equals), text.substr(equals + 1)});
  }
  return options;
}

int EvaluateBody(const BodyOptions& options) {
  const auto phases = PhasesOf(options);
  if (!phases) {
    return Refuse(kCommand, phases.error());
  }
  const auto reading = AssignmentsOf(options.sensors);
  if (!reading) {
    return Refuse(kCommand, reading.error());
  }
  const auto recording = gateway::ReadRecording(options.data, *reading);
  if (!recording) {
    return Refuse(kCommand, recording.error());
  }
  BodyTrialOptions trial;
  trial.filter = options.filter;
  if (options.pose_s >= 0.0) {
    trial.reference_pose_s = options.pose_s;
    trial.walk_until_s = options.until_s > 0.0 ? options.until_s : ToSeconds(recording->duration());
  } else {
    trial.posture.automatic_calibration = true;
  }
  const auto trace = RunCalibratedTrial(*recording, trial);
  if (!trace) {
    return Refuse(kCommand, trace.error());
  }
  for (const std::string& event : trace->events) {
    fmt::print("{}\n", event);
  }
  if (!trace->calibrated) {
    return Refuse(kCommand, {ErrorCode::kInvalidArgument,
                             "no calibration: the recording needs a still, upright stance and then "
                             "15 s of walking"});
  }
  const std::vector<BodyFigure> figures = BodyFigures(*trace, *phases);
  fmt::print("{}", FiguresText(figures));
  if (!options.out.empty()) {
    const std::string page = options.out + "/body.html";
    if (Status saved = SaveText(page, BodyHtml(options.data, *trace, figures)); !saved) {
      return Refuse(kCommand, saved.error());
    }
    fmt::print("-> {}\n", page);
  }
  return std::all_of(figures.begin(), figures.end(),
                     [](const BodyFigure& figure) { return figure.holds(); })
             ? 0
             : 1;
}

}  // namespace

SubCommand AddEvaluateBody(CLI::App& evaluate) {
  auto options = std::make_shared<BodyOptions>();
  CLI::App* app = evaluate.add_subcommand(
      "body",
      "A recording of a whole person, calibrated by itself from standing and walking: joints and "
      "headings.\nExit status 1 when a figure is out of its range.\nExample:\n  limbcast evaluate "
      "body --data ../shared/data/fullbody/walking_fullbody.hdf5 --stand 1.6:4 --sit 13:38.5 "
      "--walk 56:75 --walk 77:98 --out /tmp/body");
  app->add_option("--data", options->data, "A recording")->required();
  app->add_option("--sensor", options->sensors,
                  "NAME=segment: where a sensor is worn, by label or serial number");
  app->add_option("--filter", options->filter, "Orientation filter");
  app->add_option("--stand", options->stand, "FROM:TO in seconds: stands upright");
  app->add_option("--sit", options->sit, "FROM:TO: sits");
  app->add_option("--walk", options->walks, "FROM:TO: walks straight on; again: and back");
  app->add_option("--pose", options->pose_s,
                  "Take the reference pose at this second, by command, and the rest as the walk")
      ->check(CLI::Range(0.0, 1e5));
  app->add_option("--until", options->until_s, "... which ends here")->check(CLI::Range(0.0, 1e5));
  app->add_option("--out", options->out, "Folder for body.html with the plots");
  return {.app = app, .run = [options] { return EvaluateBody(*options); }};
}

}  // namespace limbcast::tool
