#include "services/gateway/link_probe.hpp"

namespace limbcast::gateway {

LinkProbe::LinkProbe(WaitFor wait_for, const std::vector<SensorUid>& sensors,
                     const std::vector<BodyId>& bodies)
    : wait_for_(wait_for),
      sensor_count_(sensors.size()),
      body_count_(bodies.size()),
      silent_sensors_(sensors.begin(), sensors.end()),
      silent_bodies_(bodies.begin(), bodies.end()) {}

void LinkProbe::OnState(SensorUid uid, Time measured_at) {
  if (measured_at >= first_probe_at_) {
    silent_sensors_.erase(uid);
    any_state_ = true;
  }
}

void LinkProbe::OnSkeleton(BodyId body, Time measured_at) {
  if (measured_at >= first_probe_at_) {
    silent_bodies_.erase(body);
    any_skeleton_ = true;
  }
}

bool LinkProbe::open() const {
  switch (wait_for_) {
    case WaitFor::kNone:
      return true;
    case WaitFor::kFusion:
      return any_state_ && silent_sensors_.empty();
    case WaitFor::kPosture:
      return any_state_ && silent_sensors_.empty() && any_skeleton_ && silent_bodies_.empty();
  }
  return true;
}

std::string LinkProbe::Missing() const {
  if (!any_state_ || !silent_sensors_.empty()) {
    return "fusion: " + std::to_string(silent_sensors_.size()) + " of " +
           std::to_string(sensor_count_) + " sensors silent";
  }
  if (wait_for_ == WaitFor::kPosture && (!any_skeleton_ || !silent_bodies_.empty())) {
    return "posture: " + std::to_string(silent_bodies_.size()) + " of " +
           std::to_string(body_count_) + " bodies silent";
  }
  return "";
}

}  // namespace limbcast::gateway
