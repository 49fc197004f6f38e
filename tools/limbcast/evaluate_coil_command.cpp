#include "tools/limbcast/evaluate_coil_command.hpp"

#include <fmt/format.h>

#include <memory>
#include <string>
#include <vector>

#include "common/simulation/random.hpp"
#include "tools/limbcast/evaluate/coil_report.hpp"
#include "tools/limbcast/report/report_text.hpp"

namespace limbcast::tool {
namespace {

struct CoilOptions {
  std::uint64_t seed = simulation::kDefaultSeed;
  std::string only;
  std::string json;
};

int EvaluateCoils(const CoilOptions& options) {
  const std::vector<CoilExperiment> experiments = MakeCoilExperiments(options.seed);
  std::vector<CoilResult> results;
  for (const CoilNoise noise : {CoilNoise::kThesis, CoilNoise::kModern}) {
    for (const CoilExperiment& experiment : experiments) {
      if (experiment.name.find(options.only) != std::string::npos) {
        results.push_back(EvaluateCoil(experiment, noise, options.seed));
      }
    }
  }
  fmt::print("{}", CoilTable(experiments, results));
  if (!options.json.empty()) {
    const auto json = CoilJson(experiments, results, options.seed);
    if (Status saved = SaveText(options.json, json.dump(2) + "\n"); !saved) {
      return Refuse("limbcast evaluate coil", saved.error());
    }
  }
  return 0;
}

}  // namespace

SubCommand AddEvaluateCoil(CLI::App& evaluate) {
  auto options = std::make_shared<CoilOptions>();
  CLI::App* app = evaluate.add_subcommand(
      "coil",
      "Errors of the coil tracker in simulations of the experiments it was published with: "
      "magnetic only, fused forward, with a lag, smoothed.\nExample:\n  limbcast evaluate coil "
      "--json /tmp/coil.json");
  app->add_option("--seed", options->seed, "Seed of motions, errors and noise");
  app->add_option("--only", options->only, "Only experiments whose name has this in it");
  app->add_option("--json", options->json, "File for the figures");
  return {.app = app, .run = [options] { return EvaluateCoils(*options); }};
}

}  // namespace limbcast::tool
