#include "tools/limbcast/calibrate/live_collector.hpp"

#include <utility>

namespace limbcast::tool {

Result<std::unique_ptr<LiveCollector>> LiveCollector::Make(bus::Bus& bus, std::string sensor) {
  std::unique_ptr<LiveCollector> made(new LiveCollector(std::move(sensor)));
  LiveCollector& self = *made;
  auto info = bus.MakeReader<sensing::SensorInfo>(
      {.on_sample = [&self](const sensing::SensorInfo& value,
                            const bus::SampleInfo&) { self.OnInfo(value); },
       .on_disposed = {}});
  auto marg = bus.MakeReader<sensing::MargSample>(
      {.on_sample = [&self](const sensing::MargSample& value,
                            const bus::SampleInfo&) { self.OnSample(value); },
       .on_disposed = {}});
  auto frame = bus.MakeReader<sensing::MargFrame>(
      {.on_sample =
           [&self](const sensing::MargFrame& value, const bus::SampleInfo&) {
             for (const sensing::MargSample& sample : value.samples) {
               self.OnSample(sample);
             }
           },
       .on_disposed = {}});
  auto roster = bus.MakeReader<roster::RosterEntry>(
      {.on_sample = [&self](const roster::RosterEntry& value,
                            const bus::SampleInfo&) { self.OnRoster(value); },
       .on_disposed = {}});
  if (!info || !marg) {
    return !info ? info.error() : marg.error();
  }
  if (!frame || !roster) {
    return !frame ? frame.error() : roster.error();
  }
  made->roster_reader_ = std::move(*roster);
  made->info_reader_ = std::move(*info);
  made->marg_reader_ = std::move(*marg);
  made->frame_reader_ = std::move(*frame);
  return made;
}

void LiveCollector::OnRoster(const roster::RosterEntry& entry) {
  const std::lock_guard lock(mutex_);
  for (const roster::SensorAssignment& assignment : entry.sensors) {
    limbs_[assignment.sensor_uid.value] = std::string(body::ToString(assignment.segment));
  }
}

void LiveCollector::OnInfo(const sensing::SensorInfo& info) {
  const std::lock_guard lock(mutex_);
  infos_[info.sensor_uid.value] = info;
}

void LiveCollector::OnSample(const sensing::MargSample& sample) {
  if (sample.Has(sensing::kProbe)) {
    return;
  }
  const std::lock_guard lock(mutex_);
  streams_[sample.sensor_uid.value].Add(sample);
}

// The stream of the sensor that was asked for; of several the one with most poses.
const LiveGuidance* LiveCollector::Guided() const {
  const LiveGuidance* guided = nullptr;
  for (const auto& [uid, stream] : streams_) {
    const auto info = infos_.find(uid);
    const bool known = info != infos_.end();
    const bool chosen =
        sensor_.empty() ||
        (known && (info->second.label == sensor_ || info->second.serial == sensor_));
    if (chosen && (guided == nullptr || stream.poses() > guided->poses())) {
      guided = &stream;
    }
  }
  return guided;
}

std::string LiveCollector::Line() const {
  const std::lock_guard lock(mutex_);
  const LiveGuidance* guided = Guided();
  if (guided != nullptr) {
    return guided->Line();
  }
  return "waiting for " + (sensor_.empty() ? std::string("a sensor") : "sensor " + sensor_) +
         ": is a gateway running on this domain?";
}

bool LiveCollector::complete() const {
  const std::lock_guard lock(mutex_);
  const LiveGuidance* guided = Guided();
  return guided != nullptr && guided->complete();
}

Result<std::vector<SensorSamples>> LiveCollector::Take(bool need_raw) const {
  const std::lock_guard lock(mutex_);
  std::vector<sensing::SensorInfo> sensors;
  sensors.reserve(infos_.size());
  std::vector<sensing::MargSample> samples;
  for (const auto& [uid, info] : infos_) {
    sensors.push_back(info);
  }
  for (const auto& [uid, stream] : streams_) {
    samples.insert(samples.end(), stream.samples().begin(), stream.samples().end());
  }
  if (sensors.empty()) {
    return Error{ErrorCode::kNotFound, "no gateway has told of a sensor (sensor_info)"};
  }
  auto taken = SamplesBySensor(sensors, samples, sensor_);
  if (!taken) {
    return taken;
  }
  for (SensorSamples& sensor : *taken) {
    const auto limb = limbs_.find(sensor.info.sensor_uid.value);
    sensor.limb = limb != limbs_.end() ? limb->second : std::string();
  }
  for (const SensorSamples& sensor : *taken) {
    if (need_raw && !sensor.info.calibration.empty()) {
      return Error{ErrorCode::kInvalidArgument,
                   sensor.Name() + " is corrected already (" + sensor.info.calibration +
                       "): start the gateway with gateway.calibration_folder=\"\""};
    }
  }
  return taken;
}

}  // namespace limbcast::tool
