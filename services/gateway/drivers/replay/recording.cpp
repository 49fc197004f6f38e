#include "services/gateway/drivers/replay/recording.hpp"

#include <cmath>
#include <set>
#include <unordered_map>

namespace limbcast::gateway {

namespace {

constexpr std::string_view kDriverName = "replay";

std::string ListLabels(const Recording& recording) {
  std::string list;
  for (const RecordedSensor& sensor : recording.sensors) {
    list += (list.empty() ? "" : ", ") + sensor.info.label;
  }
  return list;
}

bool IsNamed(const RecordedSensor& sensor, const std::string& name) {
  return sensor.info.label == name || sensor.info.serial == name;
}

}  // namespace

Time RowTime(std::size_t index, double rate_hz) {
  return Time{Duration{std::llround(static_cast<double>(index) * 1e9 / rate_hz)}};
}

sensing::SensorInfo MakeReplayInfo(const std::string& serial, const std::string& label,
                                   double rate_hz, const RecordingOptions& options) {
  sensing::SensorInfo info;
  constexpr std::size_t kMaxLength = 64;  // bound of the wire type
  info.driver = kDriverName;
  info.serial = serial + options.serial_suffix;
  info.label = label.substr(0, kMaxLength);
  info.sensor_uid = MakeSensorUid(info.driver, info.serial);
  if (info.serial.size() > kMaxLength) {  // the end tells sensors of one recording apart
    info.serial.erase(0, info.serial.size() - kMaxLength);
  }
  info.rate_hz = rate_hz;
  info.gyro_range_rad_s = static_cast<float>(options.gyro_range_rad_s);
  info.accel_range_m_s2 = static_cast<float>(options.accel_range_m_s2);
  info.mag_range_tesla = static_cast<float>(options.mag_range_tesla);
  return info;
}

void CloseTick(Recording& recording, Time at, std::uint64_t device_lost) {
  recording.ticks.push_back({.at = at,
                             .marg_end = recording.marg.size(),
                             .orientation_end = recording.orientation.size(),
                             .truth_end = recording.truth.size(),
                             .device_lost = device_lost});
}

void MarkHeldMagnetometer(Recording& recording) {
  std::unordered_map<SensorUid, Eigen::Vector3f> last;
  for (sensing::MargSample& sample : recording.marg) {
    if (sample.Has(sensing::kMagMissing)) {
      continue;
    }
    const auto [entry, is_first] = last.try_emplace(sample.sensor_uid, sample.mag_tesla);
    if (!is_first && entry->second == sample.mag_tesla) {  // never for NaN
      sample.flags |= sensing::kMagHeld;
    }
    entry->second = sample.mag_tesla;
  }
}

Status Assign(Recording& recording, const RecordingOptions& options) {
  for (const RecordingOptions::Assignment& assignment : options.assignments) {
    const std::optional<body::Segment> segment = body::ParseSegment(assignment.segment);
    if (!segment) {
      return Error{ErrorCode::kInvalidArgument, "sensor '" + assignment.sensor +
                                                    "': unknown segment '" + assignment.segment +
                                                    "' (names are like right_fore_arm)"};
    }
    bool found = false;
    for (RecordedSensor& sensor : recording.sensors) {
      if (IsNamed(sensor, assignment.sensor)) {
        sensor.segment = segment;
        found = true;
      }
    }
    if (!found) {
      return Error{ErrorCode::kInvalidArgument, "unknown sensor '" + assignment.sensor + "' in " +
                                                    recording.source + ", which has " +
                                                    ListLabels(recording)};
    }
  }

  std::set<body::Segment> taken;
  for (const RecordedSensor& sensor : recording.sensors) {
    if (sensor.segment && !taken.insert(*sensor.segment).second) {
      return Error{ErrorCode::kInvalidArgument, "two sensors on segment '" +
                                                    std::string(body::ToString(*sensor.segment)) +
                                                    "', the second is '" + sensor.info.label + "'"};
    }
  }

  std::unordered_map<SensorUid, body::Segment> segment_of;
  for (const RecordedSensor& sensor : recording.sensors) {
    if (sensor.segment) {
      segment_of[sensor.info.sensor_uid] = *sensor.segment;
    }
  }
  for (body::SegmentTruth& truth : recording.truth) {
    const auto entry = segment_of.find(truth.sensor_uid);
    if (entry != segment_of.end()) {
      truth.segment = entry->second;
    }
  }
  return Ok();
}

}  // namespace limbcast::gateway
