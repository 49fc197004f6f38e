#include "services/gateway/drivers/replay/csv_columns.hpp"

#include <algorithm>

namespace limbcast::gateway {

namespace {

struct Layout {
  std::string_view stem;
  std::string_view unit;  // "" for text and numbers without a dimension
};

constexpr std::array<Layout, kCsvColumnCount> kLayout = {{
    {"time", "s"},
    {"sensor", ""},
    {"segment", ""},
    {"gyro_x", "rad_s"},
    {"gyro_y", "rad_s"},
    {"gyro_z", "rad_s"},
    {"accel_x", "m_s2"},
    {"accel_y", "m_s2"},
    {"accel_z", "m_s2"},
    {"mag_x", "tesla"},
    {"mag_y", "tesla"},
    {"mag_z", "tesla"},
    {"temperature", "celsius"},
    {"q_earth_sensor_w", ""},
    {"q_earth_sensor_x", ""},
    {"q_earth_sensor_y", ""},
    {"q_earth_sensor_z", ""},
    {"truth_q_earth_sensor_w", ""},
    {"truth_q_earth_sensor_x", ""},
    {"truth_q_earth_sensor_y", ""},
    {"truth_q_earth_sensor_z", ""},
    {"movement", ""},
}};

// Columns that only make sense together: first and how many.
struct Group {
  CsvColumn first;
  std::size_t size;
};
constexpr std::array<Group, 5> kGroups = {{{CsvColumn::kGyroX, 3},
                                           {CsvColumn::kAccelX, 3},
                                           {CsvColumn::kMagX, 3},
                                           {CsvColumn::kOrientationW, 4},
                                           {CsvColumn::kTruthW, 4}}};

Error Refusal(const std::string& column, const std::string& what) {
  return Error{ErrorCode::kCorruptData, "column '" + column + "': " + what};
}

// The column whose stem `name` begins with, followed by a unit (or nothing) that is not ours.
std::size_t ColumnOfOtherUnit(std::string_view name) {
  for (std::size_t i = 0; i < kLayout.size(); ++i) {
    const std::string_view stem = kLayout[i].stem;
    const bool stem_fits =
        name.starts_with(stem) && (name.size() == stem.size() || name[stem.size()] == '_');
    if (!kLayout[i].unit.empty() && stem_fits) {
      return i;
    }
  }
  return kCsvAbsent;
}

Status CheckComplete(const CsvHeader& header) {
  for (const CsvColumn required : {CsvColumn::kTime, CsvColumn::kSensor}) {
    if (!header.Has(required)) {
      return Refusal(CsvColumnName(static_cast<std::size_t>(required)), "is missing");
    }
  }
  for (const Group& group : kGroups) {
    const auto first = static_cast<std::size_t>(group.first);
    std::size_t present = 0;
    std::size_t missing = kCsvAbsent;
    for (std::size_t i = first; i < first + group.size; ++i) {
      present += header.at[i] != kCsvAbsent ? 1U : 0U;
      missing = header.at[i] == kCsvAbsent ? i : missing;
    }
    if (present != 0 && present != group.size) {
      return Refusal(CsvColumnName(missing), "is missing, the others of its vector are there");
    }
  }
  if (!header.Has(CsvColumn::kGyroX) && !header.Has(CsvColumn::kAccelX) &&
      !header.Has(CsvColumn::kOrientationW)) {
    return Refusal("gyro_x_rad_s", "is missing, and so are accel_* and q_earth_sensor_*");
  }
  return Ok();
}

}  // namespace

std::string CsvColumnName(std::size_t column) {
  const Layout& layout = kLayout[column];
  return std::string(layout.stem) +
         (layout.unit.empty() ? std::string() : "_" + std::string(layout.unit));
}

Result<CsvHeader> ParseCsvHeader(const std::vector<std::string_view>& names) {
  CsvHeader header;
  header.at.fill(kCsvAbsent);
  header.count = names.size();
  for (std::size_t position = 0; position < names.size(); ++position) {
    const std::string name(names[position]);
    std::size_t column = 0;
    while (column < kCsvColumnCount && CsvColumnName(column) != name) {
      ++column;
    }
    if (column == kCsvColumnCount) {
      const std::size_t meant = ColumnOfOtherUnit(name);
      return meant == kCsvAbsent
                 ? Refusal(name, "unknown; CSV.md lists the columns, e.g. gyro_x_rad_s")
                 : Refusal(name, "wrong unit, expected '" + CsvColumnName(meant) + "'");
    }
    if (header.at[column] != kCsvAbsent) {
      return Refusal(name, "stands twice");
    }
    header.at[column] = position;
  }
  if (const Status complete = CheckComplete(header); !complete) {
    return complete.error();
  }
  return header;
}

}  // namespace limbcast::gateway
