#include "services/gateway/drivers/replay/full_body_reader.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

namespace limbcast::gateway {

namespace {

std::optional<body::Segment> SegmentOfGroup(std::string_view group) {
  constexpr std::array<std::pair<std::string_view, body::Segment>, 4> kOtherNames = {{
      {"lower_back", body::Segment::kL5},
      {"upper_back", body::Segment::kT8},
      {"left_forearm", body::Segment::kLeftForeArm},
      {"right_forearm", body::Segment::kRightForeArm},
  }};
  for (const auto& [name, segment] : kOtherNames) {
    if (group == name) {
      return segment;
    }
  }
  return body::ParseSegment(group);
}

std::vector<std::string> SensorGroups(const Hdf5File& file) {
  std::vector<std::string> groups = file.Groups();
  std::erase_if(groups,
                [&](const std::string& group) { return !file.Has("/" + group + "/imu_acc"); });
  return groups;
}

struct SensorTables {
  SensorUid uid;
  NumberTable accel, gyro;
};

Result<SensorTables> ReadSensor(const Hdf5File& file, const std::string& group, std::size_t rows) {
  SensorTables sensor;
  struct Wanted {
    const char* name;
    NumberTable* table;
  };
  for (const Wanted& wanted : {Wanted{"imu_acc", &sensor.accel}, {"imu_gyr", &sensor.gyro}}) {
    const std::string dataset = "/" + group + "/" + wanted.name;
    Result<NumberTable> table = file.ReadTable(dataset, 3);
    if (!table) {
      return table.error();
    }
    if (table->rows != rows) {
      return file.MakeError(ErrorCode::kCorruptData,
                            "dataset " + dataset + " has " + std::to_string(table->rows) +
                                " rows, /time has " + std::to_string(rows));
    }
    *wanted.table = std::move(*table);
  }
  return sensor;
}

Status CheckTimes(const Hdf5File& file, const NumberTable& time_s) {
  for (std::size_t row = 0; row < time_s.rows; ++row) {
    const bool grows = row == 0 || time_s.at(row, 0) > time_s.at(row - 1, 0);
    if (!std::isfinite(time_s.at(row, 0)) || !grows) {
      return file.MakeError(ErrorCode::kCorruptData,
                            "dataset /time must grow, does not at row " + std::to_string(row));
    }
  }
  return Ok();
}

void AppendSample(Recording& recording, const SensorTables& sensor, std::size_t row, Time at) {
  sensing::MargSample sample;
  sample.sensor_uid = sensor.uid;
  sample.flags = sensing::kMagMissing | sensing::kTemperatureMissing;
  sample.measured_at = at;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const auto i = static_cast<Eigen::Index>(axis);
    sample.gyro_rad_s[i] = static_cast<float>(sensor.gyro.at(row, axis));
    sample.accel_m_s2[i] = static_cast<float>(sensor.accel.at(row, axis));
  }
  recording.marg.push_back(sample);
}

}  // namespace

bool IsFullBody(const Hdf5File& file) { return file.Has("/time") && !SensorGroups(file).empty(); }

Result<Recording> ReadFullBody(const Hdf5File& file, const std::string& name,
                               const RecordingOptions& options) {
  const Result<double> rate_hz = file.ReadSamplingRate_hz();
  if (!rate_hz) {
    return rate_hz.error();
  }
  const Result<NumberTable> time_s = file.ReadTable("/time", 1);
  if (!time_s) {
    return time_s.error();
  }
  if (const Status grows = CheckTimes(file, *time_s); !grows) {
    return grows.error();
  }

  Recording recording;
  recording.format = "full_body";
  recording.rate_hz = *rate_hz;
  std::vector<SensorTables> sensors;
  const std::string prefix = name + "/";
  for (const std::string& group : SensorGroups(file)) {
    Result<SensorTables> sensor = ReadSensor(file, group, time_s->rows);
    if (!sensor) {
      return sensor.error();
    }
    recording.sensors.push_back({.info = MakeReplayInfo(prefix + group, group, *rate_hz, options),
                                 .segment = SegmentOfGroup(group)});
    sensor->uid = recording.sensors.back().info.sensor_uid;
    sensors.push_back(std::move(*sensor));
  }

  recording.marg.reserve(time_s->rows * sensors.size());
  recording.ticks.reserve(time_s->rows);
  for (std::size_t row = 0; row < time_s->rows; ++row) {
    const Time at = Time{DurationFromSeconds(time_s->at(row, 0) - time_s->at(0, 0))};
    for (const SensorTables& sensor : sensors) {
      AppendSample(recording, sensor, row, at);
    }
    CloseTick(recording, at);
  }
  return recording;
}

}  // namespace limbcast::gateway
