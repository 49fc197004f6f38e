#include "tools/limbcast/top/top_table.hpp"

#include <fmt/format.h>

#include <cmath>
#include <string_view>

#include "common/units/units.hpp"
#include "tools/limbcast/json/value_json.hpp"

namespace limbcast::tool {
namespace {

using nlohmann::json;

double Rate_hz(std::uint64_t count, std::uint64_t before, Duration span) {
  const double span_s = ToSeconds(span);
  return count < before || span_s <= 0.0 ? 0.0 : static_cast<double>(count - before) / span_s;
}

template <typename Map, typename Key>
std::uint64_t CountIn(const Map& counts, const Key& key) {
  const auto found = counts.find(key);
  return found == counts.end() ? 0 : found->second;
}

json ProcessJson(const ServiceHealth& health, Time now) {
  json result = {{"role", health.role},
                 {"host", health.host},
                 {"pid", health.pid},
                 {"uptime_s", ToSeconds(now - health.started_at)},
                 {"age_s", ToSeconds(now - health.reported_at)},
                 {"cpu_seconds", health.cpu_seconds},
                 {"rss_mib", health.rss_mib},
                 {"last_error", health.last_error}};
  json values = json::object();
  for (const NamedValue& value : health.values) {
    values[value.name] = NumberToJson(value.value);
  }
  result["values"] = std::move(values);
  json latencies = json::object();
  for (const LatencyQuantiles& stage : health.latencies) {
    latencies[stage.stage] = {{"p50_us", stage.p50_us}, {"p99_us", stage.p99_us}};
  }
  result["latencies"] = std::move(latencies);
  return result;
}

// 1-sigma of the whole rotation.
double Sigma_deg(const body::SegmentState& state) {
  const double trace = static_cast<double>(state.cov_orientation_rad2.trace());
  return units::DegFromRad(std::sqrt(std::max(trace, 0.0)));
}

json SegmentJson(const SegmentView& segment, double rate_hz, Time now) {
  const body::SegmentState& state = segment.last;
  return {{"segment", body::ToString(state.segment)},
          {"sensor_uid", state.sensor_uid.value},
          {"rate_hz", rate_hz},
          {"age_s", ToSeconds(now - segment.last_received_at)},
          {"verdict", ToString(state.verdict)},
          {"verdicts", VerdictsToJson(state.verdicts)},
          {"lost", state.lost_count},
          {"magnetic_state", NameOf(state.magnetic_state)},
          {"heading", NameOf(state.heading)},
          {"started", state.started},
          {"degraded", state.degraded},
          {"at_rest", state.at_rest},
          {"sigma_deg", NumberToJson(Sigma_deg(state))},
          {"filter", state.filter}};
}

}  // namespace

TopCounts CountsOf(const PipelineModel& model, Time now) {
  TopCounts counts{.at = now, .states = {}, .skeletons = {}};
  for (const auto& [id, body] : model.bodies) {
    counts.skeletons[id] = body.skeletons;
    for (const auto& [segment, view] : body.segments) {
      counts.states[{id, segment}] = view.states;
    }
  }
  return counts;
}

json TopJson(const PipelineModel& model, const TopCounts& before, Time now) {
  const Duration span = now - before.at;
  json processes = json::array();
  for (const ServiceHealth& health : model.health.Processes()) {
    processes.push_back(ProcessJson(health, now));
  }
  json bodies = json::array();
  for (const auto& [id, body] : model.bodies) {
    json segments = json::array();
    for (const auto& [segment, view] : body.segments) {
      const std::uint64_t earlier = CountIn(before.states, std::pair(id, segment));
      segments.push_back(SegmentJson(view, Rate_hz(view.states, earlier, span), now));
    }
    json statuses = json::object();
    for (const body::SegmentPose& pose : body.last.segments) {
      json& count = statuses[std::string(NameOf(pose.status))];
      count = count.is_null() ? 1 : count.get<int>() + 1;
    }
    const bool heard = body.skeletons > 0;
    bodies.push_back(
        {{"body_id", id.value},
         {"person", body.person},
         {"skeleton_rate_hz", Rate_hz(body.skeletons, CountIn(before.skeletons, id), span)},
         {"skeleton_age_s", heard ? json(ToSeconds(now - body.last_received_at)) : json()},
         {"skeletons", body.skeletons},
         {"incomplete", body.incomplete},
         {"lost", body.lost},
         {"status", std::move(statuses)},
         {"segments", std::move(segments)}});
  }
  return {{"processes", std::move(processes)},
          {"bodies", std::move(bodies)},
          {"latency_us",
           {{"p50", model.latencies.total().Quantile_us(0.5)},
            {"p99", model.latencies.total().Quantile_us(0.99)}}}};
}

std::string TopText(const json& top) {
  std::string text = fmt::format("{:<10} {:>8} {:<12} {:>9} {:>7} {:>9} {:>8}  {}\n", "PROCESS",
                                 "PID", "HOST", "UP s", "AGE s", "CPU s", "MiB", "LAST ERROR");
  const auto number = [](const json& value) {
    return value.is_number() ? value.get<double>() : std::nan("");
  };
  const auto word = [](const json& value) { return value.get<std::string>(); };
  for (const json& process : top["processes"]) {
    text += fmt::format("{:<10} {:>8} {:<12.12} {:>9.1f} {:>7.1f} {:>9.2f} {:>8.1f}  {}\n",
                        word(process["role"]), process["pid"].get<std::uint32_t>(),
                        word(process["host"]), number(process["uptime_s"]),
                        number(process["age_s"]), number(process["cpu_seconds"]),
                        number(process["rss_mib"]), word(process["last_error"]));
  }
  if (top["processes"].empty()) {
    text += "(nobody reports here)\n";
  }
  text +=
      fmt::format("\nsensor to client: p50 {:.2f} ms, p99 {:.2f} ms\n",
                  number(top["latency_us"]["p50"]) / 1e3, number(top["latency_us"]["p99"]) / 1e3);
  for (const json& body : top["bodies"]) {
    text += fmt::format("\nBODY {} {}: {:.1f} skeletons a second, {} incomplete, {} lost;",
                        body["body_id"].get<std::uint32_t>(), word(body["person"]),
                        number(body["skeleton_rate_hz"]), body["incomplete"].dump(),
                        body["lost"].dump());
    for (const auto& [status, count] : body["status"].items()) {
      text += fmt::format(" {} {}", count.dump(), status);
    }
    text +=
        fmt::format("\n{:<17} {:>7} {:>7} {:<15} {:<10} {:>7} {:>6} {:<9} {}\n", "SEGMENT",
                    "RATE Hz", "AGE s", "VERDICT", "FIELD", "SIGMA °", "LOST", "STATE", "FILTER");
    for (const json& segment : body["segments"]) {
      const std::string_view state = !segment["started"].get<bool>()   ? "starting"
                                     : segment["degraded"].get<bool>() ? "degraded"
                                     : segment["at_rest"].get<bool>()  ? "rest"
                                                                       : "moving";
      text += fmt::format("{:<17} {:>7.1f} {:>7.2f} {:<15} {:<10} {:>7.2f} {:>6} {:<9} {}\n",
                          word(segment["segment"]), number(segment["rate_hz"]),
                          number(segment["age_s"]), word(segment["verdict"]),
                          word(segment["magnetic_state"]), number(segment["sigma_deg"]),
                          segment["lost"].dump(), state, word(segment["filter"]));
    }
  }
  return text;
}

}  // namespace limbcast::tool
