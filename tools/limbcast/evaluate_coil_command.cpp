#include "tools/limbcast/evaluate_coil_command.hpp"

#include <fmt/format.h>

#include <array>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "common/simulation/random.hpp"
#include "services/gateway/drivers/replay/recording_reader.hpp"
#include "tools/limbcast/evaluate/coil_adaptive.hpp"
#include "tools/limbcast/evaluate/coil_beyond.hpp"
#include "tools/limbcast/evaluate/coil_endurance.hpp"
#include "tools/limbcast/evaluate/coil_recording.hpp"
#include "tools/limbcast/evaluate/coil_repetitions.hpp"
#include "tools/limbcast/evaluate/coil_report.hpp"
#include "tools/limbcast/evaluate/coil_states.hpp"
#include "tools/limbcast/evaluate/parallel.hpp"
#include "tools/limbcast/evaluate/progress_bar.hpp"
#include "tools/limbcast/evaluate/recordings.hpp"
#include "tools/limbcast/report/report_text.hpp"

namespace limbcast::tool {
namespace {

struct CoilOptions {
  std::uint64_t seed = simulation::kDefaultSeed;
  std::string only;
  std::string data;
  double hours = 0.0;
  int runs = 0;
  int repetitions = kCoilRepetitions;
  bool adaptive = false;
  bool sources = false;
  bool states = false;
  std::string json;
};

constexpr const char* kCommand = "limbcast evaluate coil";

int Save(const CoilOptions& options, const nlohmann::json& json) {
  if (!options.json.empty()) {
    if (Status saved = SaveText(options.json, json.dump(2) + "\n"); !saved) {
      return Refuse(kCommand, saved.error());
    }
  }
  return 0;
}

// What `evaluate` says of the experiments that are asked for, at each noise.
template <typename Result>
std::vector<Result> OfEach(const CoilOptions& options,
                           const std::vector<CoilExperiment>& experiments,
                           Result (*evaluate)(const CoilExperiment&, CoilNoise, std::uint64_t)) {
  const std::vector<CoilCase> wanted = CoilCasesOf(experiments, options.only);
  std::vector<Result> results(wanted.size());
  ForEachIndex(wanted.size(), [&](std::size_t i) {
    results[i] = evaluate(experiments[wanted[i].experiment], wanted[i].noise, options.seed);
  });
  return results;
}

int EvaluateExperiments(const CoilOptions& options) {
  const std::vector<CoilExperiment> experiments = MakeCoilExperiments(options.seed);
  const auto results = RepeatCoilExperiments(
      options.only, options.seed, options.repetitions,
      [](std::size_t done, std::size_t all) { ShowProgress(done, all, "trials"); });
  fmt::print("{}", CoilTable(experiments, results));
  return Save(options, CoilJson(experiments, results, options.seed));
}

int EvaluatePulsing(const CoilOptions& options) {
  std::vector<CoilExperiment> experiments = MakeCoilExperiments(options.seed);
  experiments.push_back(MakeRestingExperiment());
  const auto results = OfEach<CoilAdaptiveResult>(options, experiments, &EvaluateAdaptive);
  fmt::print("{}", AdaptiveTable(results));
  return Save(options, AdaptiveJson(results, options.seed));
}

int EvaluateSources(const CoilOptions& options) {
  const std::vector<CoilExperiment> experiments = MakeCoilExperiments(options.seed);
  const auto results = OfEach<CoilBeyondResult>(options, experiments, &EvaluateBeyond);
  fmt::print("{}", BeyondTable(results));
  return Save(options, BeyondJson(results, options.seed));
}

int EvaluateStates(const CoilOptions& options) {
  const std::vector<CoilCase> wanted = CoilCasesOf(MakeCoilExperiments(options.seed), options.only);
  std::vector<CoilStatesResult> results(wanted.size());
  ForEachIndex(wanted.size(), [&](std::size_t i) {
    results[i] = EvaluateCoilStates(wanted[i].experiment, wanted[i].noise, options.seed,
                                    options.repetitions);
  });
  fmt::print("{}", CoilStatesTable(results));
  return Save(options, CoilStatesJson(results, options.seed));
}

int EvaluateRecordings(const CoilOptions& options) {
  const auto files = RecordingsIn(options.data);
  if (!files) {
    return Refuse(kCommand, files.error());
  }
  std::vector<CoilResult> results;
  for (const std::filesystem::path& file : *files) {
    if (file.stem().string().find(options.only) == std::string::npos) {
      continue;
    }
    const auto recording = gateway::ReadRecording(file);
    if (!recording) {
      return Refuse(kCommand, recording.error());
    }
    const auto gaps = GapTrialOf(*recording, file.stem().string());
    std::array<std::optional<CoilResult>, kCoilNoises.size()> of_file;
    ForEachIndex(kCoilNoises.size(), [&](std::size_t i) {
      if (const auto trial = gaps ? MakeCoilTrial(*gaps, kCoilNoises[i], options.seed)
                                  : std::optional<CoilTrial>()) {
        of_file[i] = EvaluateTrial(*trial);
      }
    });
    for (const auto& result : of_file) {
      if (!result) {
        return Refuse(kCommand,
                      {ErrorCode::kCorruptData,
                       file.string() + " has no motion with a known position to compare with"});
      }
      results.push_back(*result);
    }
  }
  if (results.empty()) {
    return Refuse(kCommand, {ErrorCode::kNotFound, "no recording in " + options.data +
                                                       " has a name with '" + options.only + "'"});
  }
  fmt::print("{}", CoilTable({}, results));
  return Save(options, CoilJson({}, results, options.seed));
}

int EvaluateEndurance(const CoilOptions& options) {
  nlohmann::json json = {{"seed", options.seed}};
  if (options.hours > 0.0) {
    const double all_s = 3600.0 * options.hours;
    const CoilEndurance one = RunCoilSubject(options.seed, all_s, 0.0, [all_s](double t_s) {
      ShowProgress(static_cast<std::size_t>(t_s), static_cast<std::size_t>(all_s), "one subject");
    });
    fmt::print("{}", EnduranceText("one subject", one));
    json["one_subject"] = EnduranceJson(one);
  }
  if (options.runs > 0) {
    const auto all = static_cast<std::size_t>(options.runs);
    const CoilEndurance many = RunCoilSubjects(options.seed, options.runs, [all](int done) {
      ShowProgress(static_cast<std::size_t>(done), all, "subjects of 20 s");
    });
    fmt::print("{}", EnduranceText("subjects of 20 s", many));
    json["subjects"] = EnduranceJson(many);
  }
  return Save(options, json);
}

int EvaluateCoils(const CoilOptions& options) {
  const bool endurance = options.hours > 0.0 || options.runs > 0;
  if ((endurance || options.adaptive || options.sources || options.states) &&
      !options.data.empty()) {
    return Refuse(kCommand, {ErrorCode::kInvalidArgument,
                             "--data is for recordings; --hours, --runs, --adaptive, --sources and "
                             "--states are for simulations"});
  }
  if (options.states) {
    return EvaluateStates(options);
  }
  if (options.sources) {
    return EvaluateSources(options);
  }
  if (options.adaptive) {
    return EvaluatePulsing(options);
  }
  if (endurance) {
    return EvaluateEndurance(options);
  }
  return options.data.empty() ? EvaluateExperiments(options) : EvaluateRecordings(options);
}

}  // namespace

SubCommand AddEvaluateCoil(CLI::App& evaluate) {
  auto options = std::make_shared<CoilOptions>();
  CLI::App* app = evaluate.add_subcommand(
      "coil",
      "Errors of the coil tracker: in simulations of the experiments it was published with, on "
      "recorded inertial data under simulated pulses (--data), or over long time and many subjects "
      "(--hours, --runs); magnetic only, loosely coupled, fused forward, with a lag, "
      "smoothed.\nExamples:\n"
      "  limbcast evaluate coil --json /tmp/coil.json\n"
      "  limbcast evaluate coil --data ../shared/data/broad --only 16\n"
      "  limbcast evaluate coil --hours 10 --runs 1000\n"
      "  limbcast evaluate coil --adaptive\n"
      "  limbcast evaluate coil --sources\n"
      "  limbcast evaluate coil --states");
  app->add_option("--seed", options->seed, "Seed of motions, errors and noise");
  app->add_option("--repetitions", options->repetitions,
                  "How often each published experiment is simulated; the thesis did it ten times")
      ->capture_default_str()
      ->check(CLI::Range(1, 1000));
  app->add_option("--only", options->only,
                  "Only experiments or recordings whose name has this in it");
  app->add_option("--data", options->data,
                  "A recording with optical truth, or a folder of recordings");
  app->add_option("--hours", options->hours, "Simulated hours of one subject")
      ->check(CLI::Range(0.0, 1000.0));
  app->add_option("--runs", options->runs,
                  "Simulated subjects of 20 s each; track is taken away from half of them")
      ->check(CLI::Range(0, 1'000'000));
  app->add_flag("--adaptive", options->adaptive,
                "Pulses when the filter is uncertain, beside pulses in turn");
  app->add_flag("--sources", options->sources,
                "Sources that were not published: coils apart, and three tones at once");
  app->add_flag("--states", options->states,
                "What the filter's states beyond the specification gain");
  app->add_option("--json", options->json, "File for the figures");
  return {.app = app, .run = [options] { return EvaluateCoils(*options); }};
}

}  // namespace limbcast::tool
