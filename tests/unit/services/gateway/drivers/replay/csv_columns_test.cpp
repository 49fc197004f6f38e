#include "services/gateway/drivers/replay/csv_columns.hpp"

#include <gtest/gtest.h>

namespace limbcast::gateway {
namespace {

TEST(CsvColumnsTest, FindsColumnsInAnyOrder) {
  const Result<CsvHeader> header = ParseCsvHeader(
      {"accel_z_m_s2", "accel_y_m_s2", "accel_x_m_s2", "sensor", "temperature_celsius", "time_s"});
  ASSERT_TRUE(header.ok()) << header.error().message;
  EXPECT_EQ((*header)[CsvColumn::kTime], 5U);
  EXPECT_EQ((*header)[CsvColumn::kAccelX], 2U);
  EXPECT_EQ((*header)[CsvColumn::kTemperature], 4U);
  EXPECT_FALSE(header->Has(CsvColumn::kMagX));
  EXPECT_EQ(header->count, 6U);
}

TEST(CsvColumnsTest, EveryColumnWithAUnitRefusesAnotherUnit) {
  for (std::size_t column = 0; column < kCsvColumnCount; ++column) {
    const std::string name = CsvColumnName(column);
    const std::size_t unit = name.find("_rad_s");
    if (unit != std::string::npos) {
      const std::string other = name.substr(0, unit) + "_deg_s";
      EXPECT_EQ(ParseCsvHeader({other}).error().message,
                "column '" + other + "': wrong unit, expected '" + name + "'");
    }
  }
}

TEST(CsvColumnsTest, AFileNeedsSomethingMeasured) {
  EXPECT_EQ(ParseCsvHeader({"time_s", "sensor"}).error().message,
            "column 'gyro_x_rad_s': is missing, and so are accel_* and q_earth_sensor_*");
}

}  // namespace
}  // namespace limbcast::gateway
