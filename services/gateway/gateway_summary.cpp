#include "services/gateway/gateway_summary.hpp"

#include <fmt/format.h>

#include <nlohmann/json.hpp>

namespace limbcast::gateway {

std::string ToJson(const GatewaySummary& summary) {
  nlohmann::ordered_json json;
  json["driver"] = summary.driver;
  json["source"] = summary.source;
  json["end"] = summary.end;
  json["error"] = summary.error;
  json["bodies"] = summary.bodies;
  json["sensors"] = summary.sensors;
  json["ticks"] = summary.ticks;
  json["loops"] = summary.loops;
  json["samples_published"] = summary.published.marg + summary.published.orientation;
  json["marg_published"] = summary.published.marg;
  json["orientation_published"] = summary.published.orientation;
  json["markers_published"] = summary.published.markers;
  json["coil_bursts_published"] = summary.published.coil_bursts;
  json["truth_published"] = summary.published.truth;
  json["samples_saturated"] = summary.published.saturated;
  json["samples_mag_missing"] = summary.published.mag_missing;
  json["write_errors"] = summary.published.write_errors;
  json["device_lost"] = summary.device_lost;
  json["time_jumps"] = summary.time_jumps;
  json["samples_unanswered"] = summary.samples_unanswered;
  json["ticks_unanswered"] = summary.ticks_unanswered;
  json["late_answers"] = summary.late_answers;
  json["link_losses"] = summary.link_losses;
  json["wait_timed_out"] = summary.wait_timed_out;
  json["waited_s"] = summary.waited_s;
  json["stream_s"] = summary.stream_s;
  json["wall_s"] = summary.wall_s;
  json["max_lag_ms"] = summary.max_lag_ms;
  auto& by_sensor = json["by_sensor"] = nlohmann::ordered_json::object();
  for (const SensorSummary& sensor : summary.by_sensor) {
    std::string name = sensor.label;
    for (int copy = 2; by_sensor.contains(name); ++copy) {  // several people have a head
      name = fmt::format("{} ({})", sensor.label, copy);
    }
    by_sensor[name] = {{"published", sensor.published}, {"unanswered", sensor.unanswered}};
  }
  // Labels come from files: bytes that are no UTF-8 must not throw here.
  return json.dump(2, ' ', false, nlohmann::ordered_json::error_handler_t::replace);
}

std::string ToText(const GatewaySummary& summary) {
  return fmt::format(
      "{}: {} samples of {} sensors in {} ticks, {:.1f} s of data in {:.1f} s; unanswered {}, lost "
      "by device {}, time jumps {}, write errors {}",
      summary.end, summary.published.marg + summary.published.orientation, summary.sensors,
      summary.ticks, summary.stream_s, summary.wall_s, summary.samples_unanswered,
      summary.device_lost, summary.time_jumps, summary.published.write_errors);
}

void AddValues(const GatewaySummary& summary, ServiceHealth& health) {
  const auto add = [&health](const char* name, auto value) {
    health.values.push_back({name, static_cast<double>(value)});
  };
  add("samples.published", summary.published.marg + summary.published.orientation);
  add("samples.marg", summary.published.marg);
  add("samples.orientation", summary.published.orientation);
  add("samples.markers", summary.published.markers);
  add("samples.coil_bursts", summary.published.coil_bursts);
  add("samples.truth", summary.published.truth);
  add("samples.saturated", summary.published.saturated);
  add("samples.mag_missing", summary.published.mag_missing);
  add("samples.device_lost", summary.device_lost);
  add("samples.unanswered", summary.samples_unanswered);
  add("samples.write_errors", summary.published.write_errors);
  add("ticks.published", summary.ticks);
  add("ticks.unanswered", summary.ticks_unanswered);
  add("loops", summary.loops);
  add("time_jumps", summary.time_jumps);
  add("link_losses", summary.link_losses);
  add("wait_timeouts", summary.wait_timed_out ? 1 : 0);
  add("gauge.sensors", summary.sensors);
  add("gauge.bodies", summary.bodies);
  add("gauge.max_lag_ms", summary.max_lag_ms);
}

}  // namespace limbcast::gateway
