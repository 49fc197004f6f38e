#include "services/gateway/drivers/replay/xsens_reader.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <utility>

#include "common/math/rotation.hpp"
#include "services/gateway/drivers/replay/arrival_order.hpp"
#include "services/gateway/drivers/replay/text_fields.hpp"

namespace limbcast::gateway {

namespace {

constexpr std::string_view kCounterColumn = "PacketCounter";
constexpr std::string_view kRateKey = "Update Rate:";
constexpr double kMaxRate_hz = 100'000.0;
constexpr double kMaxOrthogonalityError = 0.01;  // the files have six decimals
constexpr std::size_t kAbsent = static_cast<std::size_t>(-1);

Error AtLine(const XsensFile& file, std::size_t line, const std::string& what) {
  return Error{ErrorCode::kCorruptData, file.name + ":" + std::to_string(line) + ": " + what};
}

// Where the columns are; kAbsent for gyro columns that a file need not have.
struct Columns {
  std::size_t counter = kAbsent;
  std::array<std::size_t, 3> accel{};
  std::array<std::array<std::size_t, 3>, 3> matrix{};
  std::array<std::size_t, 3> gyro{kAbsent, kAbsent, kAbsent};
  std::size_t count = 0;
};

Result<Columns> FindColumns(const XsensFile& file, std::size_t line,
                            const std::vector<std::string_view>& names) {
  Columns columns;
  columns.count = names.size();
  std::string missing;
  const auto find = [&](const std::string& name) {
    const auto at = std::find(names.begin(), names.end(), name);
    if (at == names.end() && missing.empty()) {
      missing = name;
    }
    return static_cast<std::size_t>(at - names.begin());
  };
  const std::string axes = "XYZ";
  columns.counter = find(std::string(kCounterColumn));
  for (std::size_t row = 0; row < 3; ++row) {
    columns.accel[row] = find(std::string("Acc_") + axes[row]);
    for (std::size_t column = 0; column < 3; ++column) {
      columns.matrix[row][column] =
          find("Mat[" + std::to_string(row + 1) + "][" + std::to_string(column + 1) + "]");
    }
  }
  if (!missing.empty()) {
    return AtLine(file, line, "column '" + missing + "' is missing");
  }
  if (std::find(names.begin(), names.end(), "Gyr_X") != names.end()) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      columns.gyro[axis] = find(std::string("Gyr_") + axes[axis]);
    }
  }
  return missing.empty() ? Result<Columns>(columns)
                         : AtLine(file, line, "column '" + missing + "' is missing");
}

struct Header {
  double rate_hz = 0.0;
  Columns columns;
};

// Leaves `lines` at the first row of numbers.
Result<Header> ReadHeader(const XsensFile& file, LineReader& lines) {
  Header header;
  std::vector<std::string_view> fields;
  while (const std::optional<std::string_view> line = lines.Next()) {
    if (!line->starts_with("//")) {
      SplitFields(*line, '\t', fields);
      const Result<Columns> columns = FindColumns(file, lines.number(), fields);
      if (!columns) {
        return columns.error();
      }
      if (header.rate_hz == 0.0) {
        return AtLine(file, lines.number(), "no '// Update Rate: ...Hz' line in the header");
      }
      header.columns = *columns;
      return header;
    }
    const std::size_t key = line->find(kRateKey);
    if (key != std::string_view::npos) {
      SplitFields(line->substr(key + kRateKey.size()), 'H', fields);  // " 100.0Hz"
      const std::optional<double> rate_hz = ParseNumber(fields.front());
      if (!rate_hz || !(*rate_hz > 0.0 && *rate_hz <= kMaxRate_hz)) {
        return AtLine(file, lines.number(), "Update Rate must be in (0, 100000] Hz");
      }
      header.rate_hz = *rate_hz;
    }
  }
  return AtLine(file, lines.number(), "ends before the line of column names");
}

// Reads numbers of one row; remembers the first field that is none.
class RowReader {
 public:
  RowReader(const XsensFile& file, const std::vector<std::string_view>& fields, std::size_t line)
      : file_(file), fields_(fields), line_(line) {}

  double Number(std::size_t column) {
    const std::optional<double> number = ParseNumber(fields_[column]);
    if (!number && !error_) {
      error_ = AtLine(file_, line_,
                      "column " + std::to_string(column + 1) + ": '" +
                          std::string(fields_[column]) + "' is no number");
    }
    return number.value_or(0.0);
  }
  [[nodiscard]] const std::optional<Error>& error() const { return error_; }

 private:
  const XsensFile& file_;
  const std::vector<std::string_view>& fields_;
  std::size_t line_;
  std::optional<Error> error_;
};

// Packets since the reference packet, from a 16-bit counter that wraps: the nearest fit to the last
// one.
class CounterUnwrapper {
 public:
  explicit CounterUnwrapper(std::int64_t reference) : last_(reference) {}
  std::int64_t Unwrap(std::int64_t counter) {
    constexpr std::int64_t kWrap = 65536;
    std::int64_t step = (counter - last_) % kWrap;
    step += step < -kWrap / 2 ? kWrap : 0;
    step -= step >= kWrap / 2 ? kWrap : 0;
    last_ += step;
    return last_;
  }

 private:
  std::int64_t last_;
};

Result<sensing::FusedOrientation> ReadRow(RowReader& row, const Columns& columns) {
  sensing::FusedOrientation sample;
  Eigen::Matrix3d R_earth_sensor;
  for (std::size_t r = 0; r < 3; ++r) {
    const auto i = static_cast<Eigen::Index>(r);
    sample.accel_m_s2[i] = static_cast<float>(row.Number(columns.accel[r]));
    for (std::size_t c = 0; c < 3; ++c) {
      R_earth_sensor(i, static_cast<Eigen::Index>(c)) = row.Number(columns.matrix[r][c]);
    }
  }
  if (columns.gyro.front() == kAbsent) {
    sample.flags |= sensing::kGyroMissing;
  } else {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      sample.gyro_rad_s[static_cast<Eigen::Index>(axis)] =
          static_cast<float>(row.Number(columns.gyro[axis]));
    }
  }
  if (row.error()) {
    return *row.error();
  }
  if (R_earth_sensor.allFinite()) {
    const Eigen::Matrix3d off = R_earth_sensor.transpose() * R_earth_sensor;
    if (!off.isIdentity(kMaxOrthogonalityError) || R_earth_sensor.determinant() < 0.0) {
      return Error{ErrorCode::kCorruptData, "Mat is no rotation matrix"};
    }
    sample.q_earth_sensor =
        math::Canonical(math::QuaternionFromMatrix(R_earth_sensor).normalized());
  } else {  // passed on as it is
    sample.q_earth_sensor.coeffs().setConstant(std::nan(""));
  }
  return sample;
}

// The first counter of the recording; set by the first row of the first file.
struct Reference {
  std::optional<std::int64_t> counter;
};

Status ReadFile(const XsensFile& file, std::size_t sensor_index, SensorUid uid, LineReader& lines,
                const Header& header, Reference& reference, Collected& collected) {
  std::vector<std::string_view> fields;
  std::optional<CounterUnwrapper> unwrapper;
  std::int64_t latest = 0;
  bool first = true;
  while (const std::optional<std::string_view> line = lines.Next()) {
    SplitFields(*line, '\t', fields);
    if (fields.size() == 1 && fields.front().empty()) {
      continue;
    }
    if (fields.size() < header.columns.count) {
      return AtLine(file, lines.number(),
                    "has " + std::to_string(fields.size()) + " columns, expected " +
                        std::to_string(header.columns.count));
    }
    RowReader row(file, fields, lines.number());
    const double counter = row.Number(header.columns.counter);
    Result<sensing::FusedOrientation> sample = ReadRow(row, header.columns);
    if (!sample) {
      return row.error() ? *row.error() : AtLine(file, lines.number(), sample.error().message);
    }
    const auto raw_counter = static_cast<std::int64_t>(std::isfinite(counter) ? counter : 0.0);
    if (!reference.counter) {
      reference.counter = raw_counter;
    }
    if (!unwrapper) {
      unwrapper.emplace(*reference.counter);
    }
    const std::int64_t packet = unwrapper->Unwrap(raw_counter) - *reference.counter;
    std::uint64_t lost_before = 0;
    if (!first && packet > latest + 1) {
      lost_before = static_cast<std::uint64_t>(packet - latest - 1);
    }
    latest = first ? packet : std::max(latest, packet);
    first = false;

    const auto time_of = [&](std::int64_t count) {
      return Time{DurationFromSeconds(static_cast<double>(count) / header.rate_hz)};
    };
    sample->sensor_uid = uid;
    sample->measured_at = time_of(packet);
    collected.arrived.push_back({.kind = ArrivedSample::Kind::kOrientation,
                                 .sensor = sensor_index,
                                 .index = collected.orientation.size(),
                                 .arrived_at = time_of(latest),
                                 .lost_before = lost_before});
    collected.orientation.push_back(*sample);
  }
  return Ok();
}

}  // namespace

bool IsXsensText(std::string_view text) {
  LineReader lines(text);
  while (const std::optional<std::string_view> line = lines.Next()) {
    if (!line->starts_with("//")) {
      return line->find(kCounterColumn) != std::string_view::npos;
    }
  }
  return false;
}

Result<std::vector<XsensFile>> LoadXsensFolder(const std::filesystem::path& folder) {
  std::vector<std::filesystem::path> paths;
  std::error_code error;
  for (const auto& entry : std::filesystem::directory_iterator(folder, error)) {
    if (entry.path().extension() == ".txt") {
      paths.push_back(entry.path());
    }
  }
  if (error) {
    return Error{ErrorCode::kUnavailable,
                 "cannot list " + folder.string() + ": " + error.message()};
  }
  std::sort(paths.begin(), paths.end());
  std::vector<XsensFile> files;
  for (const std::filesystem::path& path : paths) {
    Result<std::string> text = ReadWholeFile(path);
    if (!text) {
      return text.error();
    }
    if (IsXsensText(*text)) {
      const std::string stem = path.stem().string();
      const std::size_t mark = stem.rfind('_');
      files.push_back({.name = path.string(),
                       .serial = mark == std::string::npos ? stem : stem.substr(mark + 1),
                       .text = std::move(*text)});
    }
  }
  if (files.empty()) {
    return Error{ErrorCode::kNotFound, "no Xsens text export (*.txt) in " + folder.string()};
  }
  return files;
}

Result<Recording> ReadXsensText(const std::vector<XsensFile>& files,
                                const RecordingOptions& options) {
  Recording recording;
  recording.format = "xsens_text";
  Collected collected;
  Reference reference;
  for (const XsensFile& file : files) {
    LineReader lines(file.text);
    const Result<Header> header = ReadHeader(file, lines);
    if (!header) {
      return header.error();
    }
    if (recording.rate_hz != 0.0 && recording.rate_hz != header->rate_hz) {
      return Error{ErrorCode::kCorruptData,
                   file.name + ": Update Rate is " + std::to_string(header->rate_hz) +
                       " Hz, the other files have " + std::to_string(recording.rate_hz) + " Hz"};
    }
    recording.rate_hz = header->rate_hz;
    recording.sensors.push_back(
        {.info = MakeReplayInfo(file.serial, file.serial, header->rate_hz, options),
         .segment = std::nullopt});
    const Status read =
        ReadFile(file, recording.sensors.size() - 1, recording.sensors.back().info.sensor_uid,
                 lines, *header, reference, collected);
    if (!read) {
      return read.error();
    }
  }
  BuildTicks(std::move(collected), recording);
  return recording;
}

}  // namespace limbcast::gateway
