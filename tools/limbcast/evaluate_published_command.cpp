#include "tools/limbcast/evaluate_published_command.hpp"

#include <fmt/format.h>

#include <memory>
#include <string>
#include <vector>

#include "tools/limbcast/evaluate/progress_bar.hpp"
#include "tools/limbcast/evaluate/published_figures.hpp"
#include "tools/limbcast/report/report_text.hpp"

namespace limbcast::tool {
namespace {

struct CommandOptions {
  std::vector<std::string> filters = {"tqt",       "ckf", "ckf-thesis", "ckf-iron",
                                      "ckf-plain", "bmf", "gyro"};
  PublishedOptions published;
  std::string json;
};

constexpr const char* kCommand = "limbcast evaluate";

int EvaluatePublished(CommandOptions options) {
  for (const std::string& label : options.filters) {
    auto filter = FindFigureFilter(label);
    if (!filter) {
      return Refuse(kCommand, filter.error());
    }
    options.published.filters.push_back(std::move(*filter));
  }
  const auto rows = ComputePublishedRows(options.published, ShowProgress);
  std::vector<TableOneRow> table_one;
  if (options.published.only.empty() || options.published.only == "table-1") {
    table_one = ComputeTableOne(options.published.seed);
  }
  if (rows.empty() && table_one.empty()) {
    return Refuse(kCommand,
                  {ErrorCode::kInvalidArgument,
                   "--only must be one of static, quasi-static, elbow, arm, assembly or table-1, "
                   "is '" +
                       options.published.only + "'"});
  }
  fmt::print("{}", PublishedTable(options.published, rows, table_one));
  if (!options.json.empty()) {
    const nlohmann::json json = PublishedJson(options.published, rows, table_one);
    if (Status saved = SaveText(options.json, json.dump(2) + "\n"); !saved) {
      return Refuse(kCommand, saved.error());
    }
  }
  return 0;
}

}  // namespace

SubCommand AddEvaluatePublishedCommand(CLI::App& evaluate) {
  auto options = std::make_shared<CommandOptions>();
  CLI::App* app = evaluate.add_subcommand(
      "published",
      "The experiments of the publications, simulated, beside their figures.\nExample:\n  limbcast "
      "evaluate published --only elbow --filter ckf,bmf --trials 3");
  app->add_option("--seed", options->published.seed, "Of everything random");
  app->add_option("--trials", options->published.trials, "Repetitions of each experiment")
      ->check(CLI::Range(1, 100));
  app->add_option(
         "--filter", options->filters,
         "Filters, separated by commas: those of evaluate orientation, ckf-thesis, ckf-iron, gyro")
      ->delimiter(',');
  app->add_option("--only", options->published.only,
                  "Only these: static, quasi-static, elbow, arm, assembly, table-1");
  app->add_option("--json", options->json, "File for the figures");
  return {.app = app, .run = [options] { return EvaluatePublished(*options); }};
}

}  // namespace limbcast::tool
