#include "tools/limbcast/bench/users_report.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <string_view>

#include "tools/limbcast/bench/users_search.hpp"

namespace limbcast::tool {
namespace {

using nlohmann::json;

constexpr std::array<std::string_view, 4> kProcesses = {"gateway", "fusion", "posture", "client"};
constexpr double kMillisecond_us = 1e3;
constexpr double kKibPerMib = 1024.0;
constexpr double kPercent = 100.0;
constexpr double kRate_hz = 100.0;
constexpr double kLeastRate = 0.98;  // of kRate_hz; the gateway itself must keep the pace

double ValueOf(const std::map<std::string, double>& values, std::string_view name) {
  const auto found = values.find(std::string(name));
  return found == values.end() ? 0.0 : found->second;
}

double ServiceMemory_mib(const UsersRun& run) {
  return ValueOf(run.rss_mib, "fusion") + ValueOf(run.rss_mib, "posture");
}

template <typename Value>
std::optional<StraightLine> LineThrough(const std::vector<UsersRun>& runs,
                                        const UsersLimits& limits, Value value) {
  std::vector<std::pair<double, double>> points;
  for (const UsersRun& run : runs) {
    if (Complaint(run, limits).empty()) {
      points.emplace_back(run.people, value(run));
    }
  }
  return FitLine(points);
}

json LineJson(const std::optional<StraightLine>& line, std::string_view unit, double scale) {
  if (!line) {
    return nullptr;
  }
  return {{fmt::format("each_person_{}", unit), scale * line->slope},
          {fmt::format("without_people_{}", unit), scale * line->offset},
          {"farthest_from_line_share", line->worst_share}};
}

json RunJson(const UsersRun& run, const UsersLimits& limits) {
  const std::string complaint = Complaint(run, limits);
  return {{"people", run.people},
          {"held", complaint.empty()},
          {"complaint", complaint},
          {"samples", run.samples},
          {"samples_lost", run.samples_lost},
          {"skeletons", run.skeletons},
          {"skeletons_lost", run.skeletons_lost},
          {"skeletons_incomplete", run.incomplete},
          {"skeleton_rate_hz", run.rate_hz},
          {"p50_ms", run.p50_ms},
          {"p99_ms", run.p99_ms},
          {"cores_busy", run.cores},
          {"rss_mib", run.rss_mib},
          {"host_cores_busy", run.host_cores},
          {"other_cores_busy", run.other_cores()},
          {"stolen_cores", run.stolen_cores}};
}

}  // namespace

double UsersRun::other_cores() const {
  double ours = 0.0;
  for (const auto& [name, busy] : cores) {
    ours += busy;
  }
  return std::max(0.0, host_cores - ours);
}

UsersRun RunOf(int people, const json& summary) {
  UsersRun run;
  run.people = people;
  run.clean_exit = summary["clean_exit"].get<bool>();
  run.samples = summary["samples_published"].get<std::uint64_t>();
  run.samples_lost = summary["samples_lost"].get<std::uint64_t>();
  for (const auto& [verdict, count] : summary["samples_refused"].items()) {
    run.samples_lost += count.get<std::uint64_t>();
  }
  run.skeletons = summary["skeletons"].get<std::uint64_t>();
  run.skeletons_lost = summary["skeletons_lost"].get<std::uint64_t>();
  run.incomplete = summary["skeletons_incomplete"].get<std::uint64_t>();
  run.rate_hz = summary["skeleton_rate_hz"].get<double>();
  run.p50_ms = summary["latency_us"]["p50"].get<double>() / kMillisecond_us;
  run.p99_ms = summary["latency_us"]["p99"].get<double>() / kMillisecond_us;
  run.cores = summary["cores_busy"].get<std::map<std::string, double>>();
  const auto take = [&run](const char* name) {
    const double value = ValueOf(run.cores, name);
    run.cores.erase(name);
    return value;
  };
  run.host_cores = take("host");
  run.stolen_cores = take("stolen");
  run.rss_mib = summary["rss_mib"].get<std::map<std::string, double>>();
  return run;
}

std::string Complaint(const UsersRun& run, const UsersLimits& limits) {
  if (!run.refused.empty()) {
    return run.refused;
  }
  if (run.samples_lost + run.skeletons_lost > 0) {
    return fmt::format("{} samples and {} skeletons lost, none may be", run.samples_lost,
                       run.skeletons_lost);
  }
  if (!(run.p99_ms < limits.p99_ms)) {
    return fmt::format("p99 {:.1f} ms, must be below {:.1f}", run.p99_ms, limits.p99_ms);
  }
  if (!(run.rate_hz >= kLeastRate * kRate_hz)) {
    return fmt::format("{:.1f} skeletons a second, must be {:.0f}", run.rate_hz, kRate_hz);
  }
  return run.clean_exit ? "" : "a process did not end cleanly";
}

std::string RowHeading() {
  return fmt::format(
      "{:>6} {:>8} {:>8}  {:>8} {:>8} {:>8} {:>8} {:>8}  {:>8} {:>8}  {:>6} {:>6}\n"
      "{:>6} {:>8} {:>8}  {:>8} {:>8} {:>8} {:>8} {:>8}  {:>8} {:>8}  {:>6} {:>6}\n",
      "people", "p50", "p99", "gateway", "fusion", "posture", "client", "sum", "fusion", "posture",
      "others", "stolen", "", "ms", "ms", "%/person", "%/person", "%/person", "%/person", "cores",
      "MiB", "MiB", "cores", "cores");
}

std::string Row(const UsersRun& run, const UsersLimits& limits) {
  std::string row = fmt::format("{:>6} {:>8.2f} {:>8.2f} ", run.people, run.p50_ms, run.p99_ms);
  double sum = 0.0;
  for (const std::string_view process : kProcesses) {
    const double busy = ValueOf(run.cores, process);
    sum += busy;
    row += fmt::format(" {:>8.2f}", kPercent * busy / run.people);
  }
  row += fmt::format(" {:>8.2f}  {:>8.1f} {:>8.1f}  {:>6.2f} {:>6.2f}", sum,
                     ValueOf(run.rss_mib, "fusion"), ValueOf(run.rss_mib, "posture"),
                     run.other_cores(), run.stolen_cores);
  const std::string complaint = Complaint(run, limits);
  return row + "  " + (complaint.empty() ? "held" : "NOT: " + complaint) + "\n";
}

json ReportJson(const std::string& dds, const UsersLimits& limits,
                const std::vector<UsersRun>& runs) {
  int largest = 0;
  json rows = json::array();
  for (const UsersRun& run : runs) {
    rows.push_back(RunJson(run, limits));
    if (Complaint(run, limits).empty()) {
      largest = std::max(largest, run.people);
    }
  }
  json cost = json::object();
  for (const std::string_view process : kProcesses) {
    cost[std::string(process)] = LineJson(
        LineThrough(runs, limits,
                    [process](const UsersRun& run) { return ValueOf(run.cores, process); }),
        "core_percent", kPercent);
  }
  return {{"dds", dds},
          {"sensors_each", 15},
          {"rate_hz", kRate_hz},
          {"limit_p99_ms", limits.p99_ms},
          {"largest", largest},
          {"cpu", std::move(cost)},
          {"memory_fusion_posture",
           LineJson(LineThrough(runs, limits, ServiceMemory_mib), "kib", kKibPerMib)},
          {"runs", std::move(rows)}};
}

std::string ReportText(const json& report) {
  std::string text = fmt::format(
      "\n{} people x {} sensors x {:.0f} Hz on {} without a lost sample, p99 below {:.0f} ms\n",
      report["largest"].get<int>(), report["sensors_each"].get<int>(),
      report["rate_hz"].get<double>(), report["dds"].get<std::string>(),
      report["limit_p99_ms"].get<double>());
  constexpr double kStraight = 0.1;  // of the largest value
  const auto line = [&](std::string_view name, const json& fit, const char* unit,
                        const char* shown) {
    if (fit.is_null()) {
      return;
    }
    const double share = fit["farthest_from_line_share"].get<double>();
    text += fmt::format("  {:<18} {:8.2f} {} for each person, {:.2f} without any; {} ({:.0f} %)\n",
                        name, fit[fmt::format("each_person_{}", unit)].get<double>(), shown,
                        fit[fmt::format("without_people_{}", unit)].get<double>(),
                        share <= kStraight ? "linear" : "NOT linear", kPercent * share);
  };
  for (const auto& [process, fit] : report["cpu"].items()) {
    line(process, fit, "core_percent", "% of a core");
  }
  line("fusion + posture", report["memory_fusion_posture"], "kib", "KiB");
  return text;
}

}  // namespace limbcast::tool
