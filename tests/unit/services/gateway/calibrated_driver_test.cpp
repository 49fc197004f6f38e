#include "services/gateway/calibrated_driver.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

#include "services/gateway/calibration_file.hpp"
#include "tests/support/temporary_folder.hpp"
#include "tests/unit/services/gateway/fake_driver.hpp"

namespace limbcast::gateway {
namespace {

using ::testing::HasSubstr;

sensing::SensorCalibration Halving(const std::string& serial) {
  sensing::SensorCalibration calibration;
  calibration.serial = serial;
  calibration.calibrated_at = TimeFromNanoseconds(42);
  calibration.accel = sensing::TriadFit{};
  calibration.accel->calibration.matrix *= 0.5;
  calibration.accel->method = "ellipsoid";
  return calibration;
}

std::unique_ptr<test::FakeDriver> TwoSensors() {
  auto driver = std::make_unique<test::FakeDriver>(2, 3);
  driver->description().sensors[0].serial = "A";
  driver->description().sensors[1].serial = "B";
  return driver;
}

TEST(CalibratedDriverTest, CorrectsTheSensorsThatHaveACalibrationAndSaysSo) {
  CalibratedDriver driver(TwoSensors(), {Halving("B")});
  Batch batch;
  ASSERT_TRUE(driver.Next(batch).ok());
  EXPECT_FLOAT_EQ(batch.marg[0].accel_m_s2.z(), 9.81F);
  EXPECT_FLOAT_EQ(batch.marg[1].accel_m_s2.z(), 4.905F);
  EXPECT_EQ(driver.Describe().sensors[0].calibration, "");
  EXPECT_EQ(driver.Describe().sensors[1].calibration, "accel good");
  EXPECT_EQ(driver.Describe().sensors[1].calibrated_at, TimeFromNanoseconds(42));
  EXPECT_TRUE(driver.Rewind().ok());
}

TEST(CalibratedDriverTest, SaturationIsJudgedOnTheRawReading) {
  auto fake = TwoSensors();
  fake->description().sensors[1].accel_range_m_s2 = 9.9F;
  CalibratedDriver driver(std::move(fake), {Halving("B")});
  Batch batch;
  ASSERT_TRUE(driver.Next(batch).ok());
  EXPECT_TRUE(batch.marg[1].Has(sensing::kAccelSaturated));
  EXPECT_FALSE(batch.marg[1].Has(sensing::kMagSaturated));
}

TEST(CalibratedDriverTest, ASpoiledFileFallsBackToTheOneBeforeItWithALine) {
  const test_support::TemporaryFolder temporary;
  const std::filesystem::path& folder = temporary.path();
  ASSERT_TRUE(SaveCalibration(folder, Halving("A")).ok());
  ASSERT_TRUE(SaveCalibration(folder, Halving("A")).ok());
  std::filesystem::resize_file(folder / "A.toml", 50);
  std::ofstream(folder / "B.toml") << "nonsense";
  std::vector<std::string> warnings;
  const auto found = LoadCalibrations(folder, TwoSensors()->Describe().sensors, warnings);
  ASSERT_EQ(found.size(), 1U);
  EXPECT_EQ(found[0].serial, "A");
  ASSERT_EQ(warnings.size(), 2U);
  EXPECT_THAT(warnings[0], HasSubstr("the one before it is in force"));
  EXPECT_THAT(warnings[1], HasSubstr("the sensor stays raw"));
  const auto driver = WithCalibrations(TwoSensors(), folder);
  EXPECT_EQ(driver->Describe().sensors[0].calibration, "accel good");
}

TEST(CalibratedDriverTest, WithoutAFolderTheDriverIsTheSame) {
  auto fake = TwoSensors();
  const Driver* raw = fake.get();
  EXPECT_EQ(WithCalibrations(std::move(fake), "").get(), raw);
  auto other = TwoSensors();
  raw = other.get();
  EXPECT_EQ(WithCalibrations(std::move(other), "/nowhere/at/all").get(), raw);
}

}  // namespace
}  // namespace limbcast::gateway
