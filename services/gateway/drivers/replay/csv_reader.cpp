#include "services/gateway/drivers/replay/csv_reader.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <utility>

#include "common/math/rotation.hpp"
#include "services/gateway/drivers/replay/arrival_order.hpp"
#include "services/gateway/drivers/replay/csv_columns.hpp"
#include "services/gateway/drivers/replay/text_fields.hpp"

namespace limbcast::gateway {

namespace {

constexpr double kMaxTime_s =
    4e9;  // well inside the range of Time, and past any Unix time of today

// One row while it is read. Remembers the first refusal.
class Row {
 public:
  Row(const CsvHeader& header, const std::vector<std::string_view>& cells)
      : header_(header), cells_(cells) {}

  [[nodiscard]] std::string_view Text(CsvColumn column) const {
    return header_.Has(column) ? cells_[header_[column]] : std::string_view{};
  }

  // Nothing when the column is absent or the cell empty.
  std::optional<double> Number(std::size_t column) {
    const std::size_t position = header_.at[column];
    if (position == kCsvAbsent || cells_[position].empty()) {
      return std::nullopt;
    }
    const std::optional<double> number = ParseNumber(cells_[position]);
    if (!number) {
      Refuse(column, "'" + std::string(cells_[position]) + "' is no number");
    }
    return number;
  }
  std::optional<double> Number(CsvColumn column) {
    return Number(static_cast<std::size_t>(column));
  }

  // All of a vector, or nothing of it.
  template <int kSize>
  std::optional<Eigen::Matrix<double, kSize, 1>> Vector(CsvColumn first) {
    Eigen::Matrix<double, kSize, 1> vector;
    int present = 0;
    for (int i = 0; i < kSize; ++i) {
      const auto column = static_cast<std::size_t>(first) + static_cast<std::size_t>(i);
      const std::optional<double> number = Number(column);
      vector[i] = number.value_or(0.0);
      present += number ? 1 : 0;
      if (error_) {
        return std::nullopt;
      }
    }
    if (present != 0 && present != kSize) {
      Refuse(static_cast<std::size_t>(first), "some of the vector's cells are empty");
    }
    return present == kSize ? std::optional(vector) : std::nullopt;
  }

  void Refuse(std::size_t column, const std::string& what) {
    if (!error_) {
      error_ = "column '" + CsvColumnName(column) + "': " + what;
    }
  }
  void Refuse(CsvColumn column, const std::string& what) {
    Refuse(static_cast<std::size_t>(column), what);
  }
  [[nodiscard]] const std::optional<std::string>& error() const { return error_; }

 private:
  const CsvHeader& header_;
  const std::vector<std::string_view>& cells_;
  std::optional<std::string> error_;
};

Eigen::Quaterniond QuaternionOf(const Eigen::Vector4d& wxyz) {
  return {wxyz[0], wxyz[1], wxyz[2], wxyz[3]};
}

// Builds a Recording row by row.
class CsvRecorder {
 public:
  CsvRecorder(std::string name, const RecordingOptions& options)
      : name_(std::move(name)), options_(options) {}

  void Add(Row& row);
  Recording Finish();

 private:
  std::optional<std::size_t> SensorOf(Row& row);
  void AddMarg(Row& row, Time at, ArrivedSample& arrived);
  void AddOrientation(const Eigen::Vector4d& wxyz, Row& row, Time at, ArrivedSample& arrived);
  void AddTruth(Row& row, Time at, ArrivedSample& arrived);

  std::string name_;
  const RecordingOptions& options_;
  Recording recording_;
  Collected collected_;
  std::map<std::string, std::size_t, std::less<>> sensor_of_label_;
  std::vector<Time> latest_;  // of each sensor
  std::optional<double> first_time_s_;
};

std::optional<std::size_t> CsvRecorder::SensorOf(Row& row) {
  const std::string_view label = row.Text(CsvColumn::kSensor);
  if (label.empty() || label.size() > 64) {
    row.Refuse(CsvColumn::kSensor, "a name of 1 to 64 characters is expected");
    return std::nullopt;
  }
  const std::string_view segment_name = row.Text(CsvColumn::kSegment);
  const std::optional<body::Segment> segment =
      body::ParseSegment(segment_name.empty() ? label : segment_name);
  if (!segment && !segment_name.empty()) {
    row.Refuse(CsvColumn::kSegment, "unknown segment '" + std::string(segment_name) +
                                        "' (names are like right_fore_arm)");
    return std::nullopt;
  }
  const auto entry = sensor_of_label_.find(label);
  if (entry != sensor_of_label_.end()) {
    if (recording_.sensors[entry->second].segment != segment) {
      row.Refuse(CsvColumn::kSegment, "sensor '" + std::string(label) + "' changes its segment");
      return std::nullopt;
    }
    return entry->second;
  }
  const std::string text(label);
  recording_.sensors.push_back(
      {.info = MakeReplayInfo(name_ + "/" + text, text, 0.0, options_), .segment = segment});
  latest_.push_back(Time::min());
  return sensor_of_label_.emplace(text, recording_.sensors.size() - 1).first->second;
}

void CsvRecorder::AddMarg(Row& row, Time at, ArrivedSample& arrived) {
  sensing::MargSample sample;
  sample.sensor_uid = recording_.sensors[arrived.sensor].info.sensor_uid;
  sample.measured_at = at;
  const auto take = [&](CsvColumn column, sensing::MargFlag missing, Eigen::Vector3f& out) {
    if (const auto vector = row.Vector<3>(column)) {
      out = vector->cast<float>();
    } else {
      sample.flags |= missing;
    }
  };
  take(CsvColumn::kGyroX, sensing::kGyroMissing, sample.gyro_rad_s);
  take(CsvColumn::kAccelX, sensing::kAccelMissing, sample.accel_m_s2);
  take(CsvColumn::kMagX, sensing::kMagMissing, sample.mag_tesla);
  if (const std::optional<double> celsius = row.Number(CsvColumn::kTemperature)) {
    sample.temperature_celsius = static_cast<float>(*celsius);
  } else {
    sample.flags |= sensing::kTemperatureMissing;
  }
  arrived.kind = ArrivedSample::Kind::kMarg;
  arrived.index = collected_.marg.size();
  collected_.marg.push_back(sample);
}

void CsvRecorder::AddOrientation(const Eigen::Vector4d& wxyz, Row& row, Time at,
                                 ArrivedSample& arrived) {
  sensing::FusedOrientation sample;
  sample.sensor_uid = recording_.sensors[arrived.sensor].info.sensor_uid;
  sample.measured_at = at;
  const double norm = wxyz.norm();
  if (std::isfinite(norm) && std::abs(norm - 1.0) > 0.01) {
    row.Refuse(CsvColumn::kOrientationW,
               "norm of the quaternion must be 1, is " + std::to_string(norm));
  }
  sample.q_earth_sensor = QuaternionOf(std::isfinite(norm) ? (wxyz / norm).eval() : wxyz);
  if (const auto gyro = row.Vector<3>(CsvColumn::kGyroX)) {
    sample.gyro_rad_s = gyro->cast<float>();
  } else {
    sample.flags |= sensing::kGyroMissing;
  }
  if (const auto accel = row.Vector<3>(CsvColumn::kAccelX)) {
    sample.accel_m_s2 = accel->cast<float>();
  } else {
    sample.flags |= sensing::kAccelMissing;
  }
  arrived.kind = ArrivedSample::Kind::kOrientation;
  arrived.index = collected_.orientation.size();
  collected_.orientation.push_back(sample);
}

void CsvRecorder::AddTruth(Row& row, Time at, ArrivedSample& arrived) {
  const auto wxyz = row.Vector<4>(CsvColumn::kTruthW);
  if (!wxyz) {
    return;
  }
  const RecordedSensor& sensor = recording_.sensors[arrived.sensor];
  body::SegmentTruth truth;
  truth.segment = sensor.segment.value_or(body::Segment::kPelvis);
  truth.sensor_uid = sensor.info.sensor_uid;
  truth.measured_at = at;
  truth.sensor_valid = wxyz->allFinite() && wxyz->norm() > 0.5;
  if (truth.sensor_valid) {
    truth.q_earth_sensor = math::Canonical(QuaternionOf(*wxyz).normalized());
  }
  arrived.truth = static_cast<std::int64_t>(collected_.truth.size());
  collected_.truth.push_back(truth);
}

void CsvRecorder::Add(Row& row) {
  const std::optional<double> time_s = row.Number(CsvColumn::kTime);
  if (!time_s || !(std::abs(*time_s) <= kMaxTime_s)) {
    row.Refuse(CsvColumn::kTime, "a number in [-4e9, 4e9] is expected");
  }
  const std::optional<std::size_t> sensor = SensorOf(row);
  if (row.error() || !sensor) {
    return;
  }
  if (!first_time_s_) {
    first_time_s_ = *time_s;
  }
  const Time at{DurationFromSeconds(*time_s - *first_time_s_)};
  latest_[*sensor] = std::max(latest_[*sensor], at);

  ArrivedSample arrived{.sensor = *sensor, .arrived_at = latest_[*sensor]};
  if (const auto wxyz = row.Vector<4>(CsvColumn::kOrientationW)) {
    AddOrientation(*wxyz, row, at, arrived);
  } else {
    AddMarg(row, at, arrived);
  }
  AddTruth(row, at, arrived);
  if (const std::optional<double> movement = row.Number(CsvColumn::kMovement)) {
    arrived.movement = *movement != 0.0 ? 1 : 0;
    collected_.has_movement = true;
  }
  collected_.arrived.push_back(arrived);
}

Recording CsvRecorder::Finish() {
  BuildTicks(std::move(collected_), recording_);
  // The file does not state a rate: the median distance of its ticks does.
  std::vector<Duration> steps;
  for (std::size_t i = 1; i < recording_.ticks.size(); ++i) {
    steps.push_back(recording_.ticks[i].at - recording_.ticks[i - 1].at);
  }
  if (!steps.empty()) {
    const auto middle = steps.begin() + static_cast<std::ptrdiff_t>(steps.size() / 2);
    std::nth_element(steps.begin(), middle, steps.end());
    recording_.rate_hz = 1.0 / ToSeconds(*middle);
  }
  for (RecordedSensor& sensor : recording_.sensors) {
    sensor.info.rate_hz = recording_.rate_hz;
  }
  return std::move(recording_);
}

bool IsComment(std::string_view line) {
  const std::size_t begin = line.find_first_not_of(" \t");
  return begin == std::string_view::npos || line[begin] == '#';
}

}  // namespace

Result<Recording> ReadCsv(std::string_view text, const std::string& source, const std::string& name,
                          const RecordingOptions& options) {
  LineReader lines(text);
  const auto at_line = [&](const std::string& what) {
    return Error{ErrorCode::kCorruptData,
                 source + ":" + std::to_string(lines.number()) + ": " + what};
  };
  std::optional<CsvHeader> header;
  std::vector<std::string_view> cells;
  CsvRecorder recorder(name, options);
  while (const std::optional<std::string_view> line = lines.Next()) {
    if (IsComment(*line)) {
      continue;
    }
    SplitFields(*line, ',', cells);
    if (!header) {
      const Result<CsvHeader> parsed = ParseCsvHeader(cells);
      if (!parsed) {
        return at_line(parsed.error().message);
      }
      header = *parsed;
      continue;
    }
    if (cells.size() != header->count) {
      return at_line("has " + std::to_string(cells.size()) + " cells, expected " +
                     std::to_string(header->count));
    }
    Row row(*header, cells);
    recorder.Add(row);
    if (row.error()) {
      return at_line(*row.error());
    }
  }
  if (!header) {
    return at_line("no line of column names");
  }
  Recording recording = recorder.Finish();
  recording.format = "csv";
  return recording;
}

}  // namespace limbcast::gateway
