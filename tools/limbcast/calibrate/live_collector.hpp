#pragma once

#include <map>
#include <memory>
#include <mutex>
#include <string>
#include <vector>

#include "common/base/result.hpp"
#include "common/bus/bus.hpp"
#include "common/roster/roster.hpp"
#include "common/sensing/marg_frame.hpp"
#include "common/sensing/marg_sample.hpp"
#include "common/sensing/sensor_info.hpp"
#include "tools/limbcast/calibrate/live_guidance.hpp"
#include "tools/limbcast/calibrate/sensor_samples.hpp"

namespace limbcast::tool {

/// Collects what a gateway publishes of its sensors (marg, marg_frame, sensor_info, roster).
/// Thread-safe.
class LiveCollector {
 public:
  /// `sensor`: label or serial of the only one to collect, "" for all. `bus` outlives it.
  [[nodiscard]] static Result<std::unique_ptr<LiveCollector>> Make(bus::Bus& bus,
                                                                   std::string sensor);

  /// The line for the person: what is covered, what comes next; or what is missing to begin.
  [[nodiscard]] std::string Line() const;
  [[nodiscard]] bool complete() const;

  /// All that came. kNotFound when nothing did. With `need_raw`, kInvalidArgument when the gateway
  /// corrects the readings already: a calibration of corrected ones would be of no use.
  [[nodiscard]] Result<std::vector<SensorSamples>> Take(bool need_raw) const;

 private:
  explicit LiveCollector(std::string sensor) : sensor_(std::move(sensor)) {}
  void OnSample(const sensing::MargSample& sample);
  void OnRoster(const roster::RosterEntry& entry);
  void OnInfo(const sensing::SensorInfo& info);
  [[nodiscard]] const LiveGuidance* Guided() const;

  const std::string sensor_;
  mutable std::mutex mutex_;
  std::map<std::uint64_t, sensing::SensorInfo> infos_;
  std::map<std::uint64_t, LiveGuidance> streams_;
  std::map<std::uint64_t, std::string> limbs_;
  // Last: their threads call into the rest.
  std::unique_ptr<bus::Reader<sensing::SensorInfo>> info_reader_;
  std::unique_ptr<bus::Reader<roster::RosterEntry>> roster_reader_;
  std::unique_ptr<bus::Reader<sensing::MargSample>> marg_reader_;
  std::unique_ptr<bus::Reader<sensing::MargFrame>> frame_reader_;
};

}  // namespace limbcast::tool
