#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "common/base/result.hpp"

namespace limbcast::gateway {

/// The columns of the CSV layout. Vectors and quaternions are given by their first column; the
/// others follow in order.
enum class CsvColumn : std::uint8_t {
  kTime,
  kSensor,
  kSegment,
  kGyroX,
  kAccelX = kGyroX + 3,
  kMagX = kAccelX + 3,
  kTemperature = kMagX + 3,
  kOrientationW,
  kTruthW = kOrientationW + 4,
  kMovement = kTruthW + 4,
};
inline constexpr std::size_t kCsvColumnCount = static_cast<std::size_t>(CsvColumn::kMovement) + 1;

/// Where each column of the layout stands in a file; kCsvAbsent where it does not.
inline constexpr std::size_t kCsvAbsent = static_cast<std::size_t>(-1);
struct CsvHeader {
  std::array<std::size_t, kCsvColumnCount> at{};
  std::size_t count = 0;  ///< columns of the file

  [[nodiscard]] std::size_t operator[](CsvColumn column) const {
    return at[static_cast<std::size_t>(column)];
  }
  [[nodiscard]] bool Has(CsvColumn column) const { return (*this)[column] != kCsvAbsent; }
};

/// Finds the columns by name. The message of a refusal names the column and what is expected:
/// "column 'gyro_x_deg_s': wrong unit, expected 'gyro_x_rad_s'".
[[nodiscard]] Result<CsvHeader> ParseCsvHeader(const std::vector<std::string_view>& names);

/// Name of a column as it stands in files: "gyro_x_rad_s".
[[nodiscard]] std::string CsvColumnName(std::size_t column);

}  // namespace limbcast::gateway
