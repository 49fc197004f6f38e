#include "tools/limbcast/evaluate/orientation_report.hpp"
#include "tools/limbcast/report/report_text.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <memory>
#include <string_view>

namespace limbcast::tool {
namespace {

struct NamedGroup {
  const char* name;
  const char* key;
  std::optional<TrialGroup> group;
};
const NamedGroup kGroups[] = {{"mean of all", "all", std::nullopt},
                              {"mean of undisturbed", "undisturbed", TrialGroup::kUndisturbed},
                              {"mean of disturbed", "disturbed", TrialGroup::kDisturbed}};

nlohmann::json MeanJson(const OrientationMean& mean) {
  return {{"trials", mean.trials},
          {"total_deg", mean.total_deg},
          {"heading_deg", mean.heading_deg},
          {"inclination_deg", mean.inclination_deg},
          {"median_total_deg", mean.median_total_deg}};
}

}  // namespace

OrientationMean MeanOf(std::span<const OrientationResult> results, const std::string& filter,
                       std::optional<TrialGroup> group) {
  OrientationMean mean;
  std::vector<double> totals_deg;
  for (const OrientationResult& result : results) {
    if (result.filter != filter || (group && result.group != *group)) {
      continue;
    }
    totals_deg.push_back(result.errors.total_rms_deg());
    mean.total_deg += result.errors.total_rms_deg();
    mean.heading_deg += result.errors.heading_rms_deg();
    mean.inclination_deg += result.errors.inclination_rms_deg();
  }
  mean.trials = totals_deg.size();
  if (totals_deg.empty()) {
    return mean;
  }
  const auto n = static_cast<double>(mean.trials);
  mean.total_deg /= n;
  mean.heading_deg /= n;
  mean.inclination_deg /= n;
  std::sort(totals_deg.begin(), totals_deg.end());
  const std::size_t middle = totals_deg.size() / 2;
  mean.median_total_deg = totals_deg.size() % 2 == 1
                              ? totals_deg[middle]
                              : 0.5 * (totals_deg[middle - 1] + totals_deg[middle]);
  return mean;
}

std::vector<std::string> OutputLeads(const ReportHead& head) {
  constexpr std::string_view kKey = "output_lead_s=";
  std::vector<std::string> leads;
  for (const std::string& setting : head.settings) {
    const std::size_t at = setting.find(kKey);
    const bool is_key = at == 0 || (at != std::string::npos && setting[at - 1] == '.');
    if (is_key && std::strtod(setting.c_str() + at + kKey.size(), nullptr) != 0.0) {
      leads.push_back(setting);
    }
  }
  return leads;
}

std::string OrientationTable(const ReportHead& head, std::span<const OrientationResult> results) {
  std::string text;
  for (const std::string& setting : head.settings) {
    text += fmt::format("changed: {}\n", setting);
  }
  for (const std::string& lead : OutputLeads(head)) {
    text += fmt::format("output lead is not 0: {} (predicted ahead of each sample)\n", lead);
  }
  text += fmt::format("{:<48} {:<10} {:>8} {:>8} {:>8} {:>8} {:>7} {:>9}\n", "trial", "filter",
                      "total", "heading", "inclin.", "max", "NEES", "samples/s");
  text += fmt::format("{:<48} {:<10} {:>8} {:>8} {:>8} {:>8} {:>7} {:>9}\n", "", "", "deg RMS",
                      "deg RMS", "deg RMS", "deg", "of 3", "");
  for (const OrientationResult& r : results) {
    text += fmt::format("{:<48} {:<10} {:>8.3f} {:>8.3f} {:>8.3f} {:>8.2f} {:>7.2f} {:>9.3g}\n",
                        r.trial, r.filter, r.errors.total_rms_deg(), r.errors.heading_rms_deg(),
                        r.errors.inclination_rms_deg(), r.errors.total_max_deg(), r.mean_nees,
                        r.samples_per_s);
  }
  for (const NamedGroup& group : kGroups) {
    for (const std::string& filter : head.filters) {
      const OrientationMean mean = MeanOf(results, filter, group.group);
      if (mean.trials == 0) {
        continue;
      }
      text += fmt::format("{:<48} {:<10} {:>8.3f} {:>8.3f} {:>8.3f}  ({} trials, median {:.3f})\n",
                          group.name, filter, mean.total_deg, mean.heading_deg,
                          mean.inclination_deg, mean.trials, mean.median_total_deg);
    }
  }
  return text;
}

nlohmann::json OrientationJson(const ReportHead& head, std::span<const OrientationResult> results) {
  nlohmann::json trials = nlohmann::json::array();
  for (const OrientationResult& r : results) {
    nlohmann::json verdicts = nlohmann::json::object();
    for (std::size_t i = 0; i < kSampleVerdictCount; ++i) {
      const auto verdict = static_cast<SampleVerdict>(i);
      if (r.verdicts[verdict] > 0) {
        verdicts[std::string(ToString(verdict))] = r.verdicts[verdict];
      }
    }
    trials.push_back({{"trial", r.trial},
                      {"filter", r.filter},
                      {"total_deg", r.errors.total_rms_deg()},
                      {"heading_deg", r.errors.heading_rms_deg()},
                      {"inclination_deg", r.errors.inclination_rms_deg()},
                      {"max_deg", r.errors.total_max_deg()},
                      {"nees", r.mean_nees},
                      {"scored_samples", r.errors.count()},
                      {"samples", r.q_earth_sensor.size()},
                      {"samples_per_s", r.samples_per_s},
                      {"verdicts", verdicts}});
  }
  nlohmann::json filters = nlohmann::json::object();
  for (const std::string& filter : head.filters) {
    for (const NamedGroup& group : kGroups) {
      filters[filter][group.key] = MeanJson(MeanOf(results, filter, group.group));
    }
  }
  return {{"filters", filters},
          {"trials", trials},
          {"settings", head.settings},
          {"output_leads", OutputLeads(head)}};
}

Status SaveQuaternions(const std::filesystem::path& path,
                       std::span<const Eigen::Quaterniond> q_earth_sensor) {
  fmt::memory_buffer text;
  fmt::format_to(std::back_inserter(text), "w,x,y,z\n");
  for (const Eigen::Quaterniond& q : q_earth_sensor) {
    fmt::format_to(std::back_inserter(text), "{:.9g},{:.9g},{:.9g},{:.9g}\n", q.w(), q.x(), q.y(),
                   q.z());
  }
  return SaveText(path, fmt::to_string(text));
}

}  // namespace limbcast::tool
