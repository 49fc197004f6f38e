#include "tools/limbcast/calibrate/sensor_samples.hpp"

#include <algorithm>
#include <unordered_map>

namespace limbcast::tool {

std::string SensorSamples::Name() const {
  const bool has_label = !info.label.empty() && info.label != info.serial;
  const std::string name = has_label ? info.label + " (" + info.serial + ")" : info.serial;
  return limb.empty() || limb == info.label ? name : name + " on " + limb;
}

Result<std::vector<SensorSamples>> SamplesBySensor(std::span<const sensing::SensorInfo> sensors,
                                                   std::span<const sensing::MargSample> samples,
                                                   const std::string& chosen) {
  std::vector<SensorSamples> found;
  std::unordered_map<SensorUid, std::size_t> index;
  std::string names;
  for (const sensing::SensorInfo& info : sensors) {
    names += (names.empty() ? "" : ", ") + (info.label.empty() ? info.serial : info.label);
    if (chosen.empty() || info.label == chosen || info.serial == chosen) {
      index[info.sensor_uid] = found.size();
      found.push_back({.info = info, .samples = {}, .limb = {}});
    }
  }
  if (found.empty()) {
    return Error{ErrorCode::kNotFound, "no sensor '" + chosen + "', there are: " + names};
  }
  for (const sensing::MargSample& sample : samples) {
    if (const auto at = index.find(sample.sensor_uid);
        at != index.end() && !sample.Has(sensing::kProbe)) {
      found[at->second].samples.push_back(sample);
    }
  }
  std::erase_if(found, [](const SensorSamples& sensor) { return sensor.samples.empty(); });
  if (found.empty()) {
    return Error{ErrorCode::kNotFound, "there are no gyro, accelerometer or magnetometer readings"};
  }
  for (SensorSamples& sensor : found) {
    std::stable_sort(sensor.samples.begin(), sensor.samples.end(),
                     [](const auto& a, const auto& b) { return a.measured_at < b.measured_at; });
    const auto end =
        std::unique(sensor.samples.begin(), sensor.samples.end(),
                    [](const auto& a, const auto& b) { return a.measured_at == b.measured_at; });
    sensor.samples.erase(end, sensor.samples.end());
  }
  return found;
}

}  // namespace limbcast::tool
