#include <fmt/format.h>

#include "tools/limbcast/evaluate/published_figures.hpp"

namespace limbcast::tool {
namespace {

constexpr const char* kReadingAid =
    "Degrees, mean (standard deviation) over {} repetitions, seed {}. Published: D. Roetenberg, "
    "thesis 2006,\nsections 2.4 and 3.3, with compensation / without. Filters and gyro: simulated "
    "here. What was not printed\n(noise, ranges of movement, remanence of the iron) is in "
    "tools/limbcast/evaluate/published_experiments.cpp.\n\n";

std::string TableOneText(const std::vector<TableOneRow>& rows) {
  std::string text =
      "\nTable 1 of McGhee et al.: RMS quaternion error after full Gauss-Newton steps, published / "
      "simulated\n(dip 60 deg, double precision; published in single)\n";
  text += fmt::format("{:<10} {:>23} {:>23} {:>23}\n", "max noise", "1 step", "2 steps", "3 steps");
  for (const TableOneRow& row : rows) {
    text += fmt::format("{:<10g}", row.max_noise);
    for (std::size_t i = 0; i < 3; ++i) {
      text += fmt::format(" {:>11.3g} / {:>9.3g}", row.published[i], row.simulated[i]);
    }
    text += '\n';
  }
  return text;
}

}  // namespace

std::string PublishedTable(const PublishedOptions& options, const std::vector<PublishedRow>& rows,
                           const std::vector<TableOneRow>& table_one) {
  std::string text;
  if (!rows.empty()) {
    text += fmt::format(fmt::runtime(kReadingAid), options.trials, options.seed);
    text += fmt::format("{:<13} {:<50} {:>9} {:>7}", "experiment", "figure", "published", "plain");
    for (const FigureFilter& filter : options.filters) {
      text += fmt::format(" {:>12}", filter.label);
    }
    text += '\n';
  }
  for (const PublishedRow& row : rows) {
    text += fmt::format("{:<13} {:<50} {:>9} {:>7}", row.experiment, row.what, row.compensated,
                        row.plain);
    for (const FigureFilter& filter : options.filters) {
      const Spread& spread = row.simulated.at(filter.label);
      text += fmt::format(
          " {:>12}", row.worst ? fmt::format("to {:.1f}", spread.max_deg)
                               : fmt::format("{:.2f} ({:.2f})", spread.mean_deg, spread.std_deg));
    }
    text += '\n';
  }
  return table_one.empty() ? text : text + TableOneText(table_one);
}

nlohmann::json PublishedJson(const PublishedOptions& options, const std::vector<PublishedRow>& rows,
                             const std::vector<TableOneRow>& table_one) {
  nlohmann::json figures = nlohmann::json::array();
  for (const PublishedRow& row : rows) {
    nlohmann::json simulated = nlohmann::json::object();
    for (const auto& [label, spread] : row.simulated) {
      simulated[label] = {
          {"mean_deg", spread.mean_deg}, {"std_deg", spread.std_deg}, {"max_deg", spread.max_deg}};
    }
    figures.push_back({{"experiment", row.experiment},
                       {"figure", row.what},
                       {"published_compensated_deg", row.compensated},
                       {"published_plain_deg", row.plain},
                       {"simulated", simulated}});
  }
  nlohmann::json cells = nlohmann::json::array();
  for (const TableOneRow& row : table_one) {
    cells.push_back(
        {{"max_noise", row.max_noise}, {"published", row.published}, {"simulated", row.simulated}});
  }
  return {
      {"seed", options.seed}, {"trials", options.trials}, {"figures", figures}, {"table_1", cells}};
}

}  // namespace limbcast::tool
