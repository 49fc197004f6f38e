#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <unordered_set>
#include <vector>

#include "common/base/ids.hpp"
#include "common/base/time.hpp"
#include "services/gateway/gateway_config.hpp"

namespace limbcast::gateway {

/// Keeps which of those that must answer link probes have done so. Thread-compatible.
class LinkProbe {
 public:
  /// `sensors` and `bodies` must all answer (bodies only for WaitFor::kPosture). Without any, one
  /// answer of anybody will do.
  LinkProbe(WaitFor wait_for, const std::vector<SensorUid>& sensors,
            const std::vector<BodyId>& bodies);

  /// Answers to probes sent before this are not counted.
  void Start(Time first_probe_at) { first_probe_at_ = first_probe_at; }

  void OnState(SensorUid uid, Time measured_at);
  void OnSkeleton(BodyId body, Time measured_at);

  [[nodiscard]] bool open() const;
  /// Who has not answered, for people: "fusion: 3 of 15 sensors silent".
  [[nodiscard]] std::string Missing() const;

 private:
  WaitFor wait_for_;
  Time first_probe_at_{};
  std::size_t sensor_count_;
  std::size_t body_count_;
  std::unordered_set<SensorUid> silent_sensors_;
  std::unordered_set<BodyId> silent_bodies_;
  bool any_state_ = false;
  bool any_skeleton_ = false;
};

}  // namespace limbcast::gateway
