#include "tools/limbcast/demo/demo_summary.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <span>

#include "common/units/units.hpp"

namespace limbcast::tool {
namespace {

using nlohmann::json;

json QuantilesJson(const runtime::LatencyHistogram& histogram) {
  return {{"p50", histogram.Quantile_us(0.5)},
          {"p99", histogram.Quantile_us(0.99)},
          {"p999", histogram.Quantile_us(0.999)}};
}

json LatencyJson(const StageLatencies& latencies) {
  json result = QuantilesJson(latencies.total());
  json stages = json::object();
  for (std::size_t i = 0; i < StageLatencies::kNames.size(); ++i) {
    stages[std::string(StageLatencies::kNames[i])] = QuantilesJson(latencies.stage(i));
  }
  result["stages"] = std::move(stages);
  return result;
}

// CPU time for each skeleton, by process: from the reports of health while skeletons came, or, when
// a run is too short for two reports, from the whole life of the process.
json CpuJson(const PipelineModel& model, const DemoOutcome& outcome) {
  constexpr double kMicroseconds = 1e6;
  constexpr double kShortest_s = 1.5;
  const double frames = static_cast<double>(model.skeletons_since_mark());
  const double all_frames = static_cast<double>(model.skeletons());
  const double rate_hz = outcome.duration_s > 0.0 ? frames / outcome.duration_s : 0.0;
  json result = json::object();
  for (const auto& [role, cpu] : model.health.CpuByRole()) {
    if (cpu.span_s >= kShortest_s && rate_hz > 0.0) {
      result[role] = cpu.cpu_seconds / cpu.span_s / rate_hz * kMicroseconds;
    } else if (frames > 0 && outcome.child_cpu_seconds.contains(role)) {
      result[role] = outcome.child_cpu_seconds.at(role) / all_frames * kMicroseconds;
    }
  }
  if (frames > 0) {
    result["client"] = outcome.client_cpu_seconds / frames * kMicroseconds;
  }
  return result;
}

// Cores that were busy on average: by process, and everything on this host.
json CoresJson(const PipelineModel& model, const DemoOutcome& outcome) {
  json result = json::object();
  for (const auto& [role, cpu] : model.health.CpuByRole()) {
    if (cpu.span_s > 0.0) {
      result[role] = cpu.cpu_seconds / cpu.span_s;
    }
  }
  if (outcome.duration_s > 0.0) {
    result["client"] = outcome.client_cpu_seconds / outcome.duration_s;
    result["host"] = outcome.host_busy_seconds / outcome.duration_s;
    result["stolen"] = outcome.host_stolen_seconds / outcome.duration_s;
  }
  return result;
}

json MemoryJson(const PipelineModel& model, const DemoOutcome& outcome) {
  json result = json::object();
  for (const ServiceHealth& process : model.health.Processes()) {
    result[process.role] = process.rss_mib;
  }
  result["client"] = outcome.client_rss_mib;
  return result;
}

json ErrorJson(const OrientationErrors& errors) {
  const auto summary = errors.Get();
  if (!summary) {
    return nullptr;
  }
  return {{"rms", units::DegFromRad(summary->rms_rad)},
          {"max", units::DegFromRad(summary->max_rad)},
          {"count", summary->count}};
}

// Sensors and joints that the demo is about, the bodies together in one RMS value each.
json PositionsJson(const std::map<PositionErrors::Key, PositionErrors::Summary>& all,
                   std::span<const body::Segment> wanted) {
  constexpr double kMillimetres = 1e3;
  json result = json::object();
  for (const auto& [key, summary] : all) {
    const auto& [body_id, segment] = key;
    if (summary.count == 0 ||
        (!wanted.empty() && std::find(wanted.begin(), wanted.end(), segment) == wanted.end())) {
      continue;
    }
    result[fmt::format("{}.{}", body_id.value, body::ToString(segment))] = {
        {"rms", kMillimetres * summary.rms_m},
        {"max", kMillimetres * summary.max_m},
        {"sigma", kMillimetres * summary.sigma_m},
        {"count", summary.count}};
  }
  return result;
}

json PositionErrorJson(const DemoOptions& options, const PositionErrors& positions) {
  if (!options.coils && !options.markers) {
    return nullptr;
  }
  using body::Segment;
  // Hands and feet begin where the skeleton has wrists and ankles; the pelvis is its root.
  static constexpr std::array kEnds = {Segment::kPelvis, Segment::kRightHand, Segment::kLeftHand,
                                       Segment::kRightFoot, Segment::kLeftFoot};
  return {{"sensors", PositionsJson(positions.sensors(), {})},
          {"sensors_lagged", PositionsJson(positions.lagged(), {})},
          {"skeleton", PositionsJson(positions.joints(), kEnds)}};
}

}  // namespace

json SummaryJson(const DemoOptions& options, const PipelineModel& model,
                 const DemoOutcome& outcome) {
  const Accounting account = Account(model.health);
  std::uint64_t incomplete = 0;
  std::uint64_t skeletons_lost = 0;
  Duration longest_step{};
  for (const auto& [id, body] : model.bodies) {
    longest_step = std::max(longest_step, body.longest_step);
    incomplete += body.incomplete;
    skeletons_lost += body.lost;
  }
  return {{"dds", ToString(options.dds)},
          {"domain_id", options.bus.domain_id},
          {"source", options.recording.empty() ? "simulator" : options.recording},
          {"duration_s", outcome.duration_s},
          {"bodies", model.bodies.size()},
          {"segments", model.tracked_segments()},
          {"samples_published", account.published},
          {"samples_filtered", account.filtered},
          {"samples_refused", account.refused},
          {"samples_lost", account.lost},
          {"samples_lost_seen_by_fusion", account.lost_seen},
          {"skeletons", model.skeletons()},
          {"skeletons_incomplete", incomplete},
          {"skeletons_lost", skeletons_lost},
          {"longest_skeleton_gap_s", ToSeconds(longest_step)},
          {"skeleton_rate_hz", model.skeleton_rate_hz()},
          {"latency_us", LatencyJson(model.latencies)},
          {"orientation_error_deg", ErrorJson(model.errors)},
          {"position_error_mm", PositionErrorJson(options, model.positions)},
          {"reference_pose", outcome.reference_pose},
          {"cpu_us_per_body_frame", CpuJson(model, outcome)},
          {"cores_busy", CoresJson(model, outcome)},
          {"rss_mib", MemoryJson(model, outcome)},
          {"restarts", outcome.restarts},
          {"without_last_report", outcome.without_last_report},
          {"clean_exit", outcome.clean_exit}};
}

std::string SummaryText(const json& summary) {
  const auto number = [](const json& value) { return value.get<double>(); };
  std::string text =
      fmt::format("\nSummary of {:.1f} s on {} (domain {}), {}\n", number(summary["duration_s"]),
                  summary["dds"].get<std::string>(), summary["domain_id"].get<int>(),
                  summary["source"].get<std::string>());
  const auto line = [&](std::string_view name, const std::string& value) {
    text += fmt::format("  {:<20} {}\n", name, value);
  };
  line("bodies, segments", fmt::format("{}, {}", summary["bodies"].get<std::uint64_t>(),
                                       summary["segments"].get<std::uint64_t>()));
  line("samples published", summary["samples_published"].dump());
  line("samples filtered", summary["samples_filtered"].dump());
  std::string refused;
  for (const auto& [verdict, count] : summary["samples_refused"].items()) {
    refused += fmt::format("{}{} {}", refused.empty() ? "" : ", ", count.dump(), verdict);
  }
  line("samples refused", refused.empty() ? "0" : refused);
  line("samples lost", summary["samples_lost"].dump());
  line("skeletons",
       fmt::format("{} ({:.2f} a second, {} incomplete, {} lost, longest gap {:.3f} s)",
                   summary["skeletons"].dump(), number(summary["skeleton_rate_hz"]),
                   summary["skeletons_incomplete"].dump(), summary["skeletons_lost"].dump(),
                   number(summary["longest_skeleton_gap_s"])));
  const json& latency = summary["latency_us"];
  line("sensor to client",
       fmt::format("p50 {:.0f} us, p99 {:.0f} us, p99.9 {:.0f} us", number(latency["p50"]),
                   number(latency["p99"]), number(latency["p999"])));
  for (const auto name : StageLatencies::kNames) {
    const json& stage = latency["stages"][std::string(name)];
    line(fmt::format("  {}", name),
         fmt::format("p50 {:.0f} us, p99 {:.0f} us", number(stage["p50"]), number(stage["p99"])));
  }
  const json& error = summary["orientation_error_deg"];
  line("orientation error", error.is_null()
                                ? "no truth to compare with"
                                : fmt::format("{:.2f} deg RMS, {:.2f} deg at most",
                                              number(error["rms"]), number(error["max"])));
  if (const json& positions = summary["position_error_mm"]; positions.is_object()) {
    for (const auto& [kind, errors] : positions.items()) {
      line("position error", kind == "sensors"    ? "of sensors (coils: in the source's axes)"
                             : kind == "skeleton" ? "of the skeleton (limbs: against the pelvis)"
                                                  : "of sensors, smoothed half a second later");
      for (const auto& [name, e] : errors.items()) {
        line(fmt::format("  {}", name),
             fmt::format("{:.1f} mm RMS, {:.1f} mm at most", number(e["rms"]), number(e["max"])));
      }
    }
  }
  if (!summary["reference_pose"].get<std::string>().empty()) {
    line("reference pose", summary["reference_pose"].get<std::string>());
  }
  for (const auto& [role, cpu] : summary["cpu_us_per_body_frame"].items()) {
    const json& memory = summary["rss_mib"];
    line(role, fmt::format("{:.0f} us CPU for each body and frame, {:.1f} MiB", number(cpu),
                           memory.contains(role) ? number(memory[role]) : 0.0));
  }
  for (const auto& [name, count] : summary["restarts"].items()) {
    line("started again", fmt::format("{}, {} times", name, count.dump()));
  }
  for (const json& name : summary["without_last_report"]) {
    line("counters", "the last report of " + name.get<std::string>() + " did not arrive");
  }
  line("clean exit", summary["clean_exit"].get<bool>() ? "yes" : "NO");
  return text;
}

std::string ProgressLine(const PipelineModel& model, double elapsed_s) {
  constexpr double kMillisecond_us = 1e3;
  std::string line =
      fmt::format("{:7.1f} s  {} bod{} {} segments  {} skeletons, {:.1f}/s  latency p50 {:.2f} ms",
                  elapsed_s, model.bodies.size(), model.bodies.size() == 1 ? "y," : "ies,",
                  model.tracked_segments(), model.skeletons(), model.skeleton_rate_hz(),
                  model.latencies.total().Quantile_us(0.5) / kMillisecond_us);
  line += fmt::format("  lost {:.0f}", model.health.Sum("fusion", "samples.lost"));
  if (const auto error = model.errors.Get()) {
    line += fmt::format("  error {:.2f} deg", units::DegFromRad(error->rms_rad));
  }
  return line;
}

}  // namespace limbcast::tool
