#include "services/gateway/drivers/replay/replay_driver.hpp"

#include <algorithm>
#include <utility>

#include "services/gateway/drivers/replay/recording_reader.hpp"

namespace limbcast::gateway {

namespace {

constexpr BodyId kReplayBody{1};
constexpr std::size_t kMaxNameLength = 64;  // bound of the wire types

// Adds the part of `from` that belongs to the tick.
template <typename T>
void AppendTick(const std::vector<T>& from, std::size_t begin, std::size_t end,
                std::vector<T>& to) {
  to.insert(to.end(), from.begin() + static_cast<std::ptrdiff_t>(begin),
            from.begin() + static_cast<std::ptrdiff_t>(end));
}

}  // namespace

ReplayConfig ReadReplayConfig(const config::Section& section, ReplayConfig defaults) {
  constexpr double kMaxRange = 1e6;
  ReplayConfig config = std::move(defaults);
  config.recording = section.Read("recording", config.recording.string(), 4096);
  config.person = section.Read("person", config.person, kMaxNameLength);
  RecordingOptions& options = config.options;
  options.serial_suffix = section.Read("serial_suffix", options.serial_suffix, 16);
  options.gyro_range_rad_s =
      section.Read("gyro_range_rad_s", options.gyro_range_rad_s, 0.0, kMaxRange);
  options.accel_range_m_s2 =
      section.Read("accel_range_m_s2", options.accel_range_m_s2, 0.0, kMaxRange);
  options.mag_range_tesla =
      section.Read("mag_range_tesla", options.mag_range_tesla, 0.0, kMaxRange);
  for (const config::Section& assign : section.GetAll("assign")) {
    RecordingOptions::Assignment assignment{.sensor = assign.Read("sensor", "", kMaxNameLength),
                                            .segment = assign.Read("segment", "", kMaxNameLength)};
    if (!body::ParseSegment(assignment.segment)) {
      assign.Fail("segment",
                  "must be a segment like right_fore_arm, is '" + assignment.segment + "'");
    }
    options.assignments.push_back(std::move(assignment));
  }
  return config;
}

Result<std::unique_ptr<ReplayDriver>> ReplayDriver::Make(const ReplayConfig& config) {
  Result<Recording> recording = ReadRecording(config.recording, config.options);
  if (!recording) {
    return recording.error();
  }
  return std::make_unique<ReplayDriver>(std::move(*recording), config.person);
}

ReplayDriver::ReplayDriver(Recording recording, std::string person)
    : recording_(std::move(recording)) {
  description_.driver = "replay";
  description_.source = recording_.source;
  description_.time = DriverTime::kRecording;
  description_.tick_rate_hz = recording_.rate_hz;
  description_.has_truth = !recording_.truth.empty();

  roster::RosterEntry entry;
  entry.body_id = kReplayBody;
  entry.revision = 1;
  entry.person = person.empty() ? std::filesystem::path(recording_.source).stem().string() : person;
  entry.person.resize(std::min(entry.person.size(), kMaxNameLength));
  for (const RecordedSensor& sensor : recording_.sensors) {
    description_.sensors.push_back(sensor.info);
    if (sensor.segment) {
      entry.sensors.push_back({.sensor_uid = sensor.info.sensor_uid, .segment = *sensor.segment});
    }
  }
  if (!entry.sensors.empty()) {
    description_.bodies.push_back(std::move(entry));
  }
  for (body::SegmentTruth& truth : recording_.truth) {
    truth.body_id = kReplayBody;
  }
}

Result<DriverStep> ReplayDriver::Next(Batch& batch) {
  batch.Clear();
  if (next_tick_ == recording_.ticks.size()) {
    return DriverStep::kEnd;
  }
  const RecordedTick before = next_tick_ == 0 ? RecordedTick{} : recording_.ticks[next_tick_ - 1];
  const RecordedTick& tick = recording_.ticks[next_tick_++];
  batch.tick_at = tick.at;
  batch.device_lost = tick.device_lost;
  AppendTick(recording_.marg, before.marg_end, tick.marg_end, batch.marg);
  AppendTick(recording_.orientation, before.orientation_end, tick.orientation_end,
             batch.orientation);
  AppendTick(recording_.truth, before.truth_end, tick.truth_end, batch.truth);
  return DriverStep::kData;
}

Status ReplayDriver::Rewind() {
  next_tick_ = 0;
  return Ok();
}

}  // namespace limbcast::gateway
