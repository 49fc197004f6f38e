#include "services/gateway/calibration_file.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <limits>

#include "common/simulation/random.hpp"
#include "tests/support/temporary_folder.hpp"

namespace limbcast::gateway {
namespace {

using ::testing::HasSubstr;

sensing::TriadFit RandomFit(simulation::Random& random, double size) {
  sensing::TriadFit fit;
  for (double& element : fit.calibration.matrix.reshaped()) {
    element += random.Uniform(-0.05, 0.05);
  }
  fit.calibration.offset = random.Uniform3(size);
  fit.method = "ellipsoid";
  fit.residual_before = random.Uniform();
  fit.residual_after = random.Uniform();
  fit.sigma_scale = random.Uniform(0.0, 0.001);
  fit.sigma_offset = random.Uniform(0.0, 0.001);
  fit.coverage = random.Uniform();
  fit.points = 1234;
  return fit;
}

sensing::SensorCalibration RandomCalibration(std::uint64_t seed, std::string serial = "sim-1") {
  simulation::Random random(seed);
  sensing::SensorCalibration calibration;
  calibration.serial = std::move(serial);
  calibration.calibrated_at = TimeFromNanoseconds(1'790'000'000'123'456'789);
  calibration.temperature_celsius = random.Uniform(-10.0, 60.0);
  calibration.gyro = RandomFit(random, 0.02);
  calibration.accel = RandomFit(random, 0.3);
  calibration.mag = RandomFit(random, 4e-5);
  return calibration;
}

void ExpectSame(const std::optional<sensing::TriadFit>& a,
                const std::optional<sensing::TriadFit>& b) {
  ASSERT_EQ(a.has_value(), b.has_value());
  if (a) {
    EXPECT_EQ(a->calibration.matrix, b->calibration.matrix);
    EXPECT_EQ(a->calibration.offset, b->calibration.offset);
    EXPECT_EQ(a->method, b->method);
    EXPECT_EQ(a->residual_before, b->residual_before);
    EXPECT_EQ(a->residual_after, b->residual_after);
    EXPECT_EQ(a->sigma_scale, b->sigma_scale);
    EXPECT_EQ(a->sigma_offset, b->sigma_offset);
    EXPECT_EQ(a->coverage, b->coverage);
    EXPECT_EQ(a->points, b->points);
  }
}

class CalibrationFileTest : public ::testing::Test {
 protected:
  void Spoil(std::size_t keep_bytes) const {
    std::filesystem::resize_file(folder_ / "sim-1.toml", keep_bytes);
  }
  const test_support::TemporaryFolder temporary_;
  const std::filesystem::path folder_ = temporary_.path();
};

TEST_F(CalibrationFileTest, SavedValuesComeBackInAllBits) {
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    const auto saved = RandomCalibration(seed);
    ASSERT_TRUE(SaveCalibration(folder_, saved).ok());
    const auto loaded = LoadCalibration(folder_, "sim-1");
    ASSERT_TRUE(loaded.ok()) << loaded.error().message;
    EXPECT_EQ(loaded->serial, saved.serial);
    EXPECT_EQ(loaded->calibrated_at, saved.calibrated_at);
    EXPECT_EQ(loaded->temperature_celsius, saved.temperature_celsius);
    ExpectSame(loaded->gyro, saved.gyro);
    ExpectSame(loaded->accel, saved.accel);
    ExpectSame(loaded->mag, saved.mag);
  }
}

TEST_F(CalibrationFileTest, WhatIsNotKnownStaysSo) {
  sensing::SensorCalibration saved;
  saved.serial = "sim-1";
  saved.temperature_celsius = std::numeric_limits<double>::quiet_NaN();
  ASSERT_TRUE(SaveCalibration(folder_, saved).ok());
  const auto loaded = LoadCalibration(folder_, "sim-1");
  ASSERT_TRUE(loaded.ok()) << loaded.error().message;
  EXPECT_TRUE(loaded->empty());
  EXPECT_TRUE(std::isnan(loaded->temperature_celsius));
}

// Cut anywhere, the file is refused: never half a calibration.
TEST_F(CalibrationFileTest, EveryHalfWrittenFileIsRefusedWithOneLine) {
  const std::string text = CalibrationToToml(RandomCalibration(3));
  for (std::size_t length = 0; length + 2 < text.size(); length += 7) {
    const auto read = CalibrationFromToml(text.substr(0, length), "x.toml");
    ASSERT_FALSE(read.ok()) << length;
    EXPECT_EQ(read.error().code, ErrorCode::kCorruptData);
    EXPECT_EQ(read.error().message.find('\n'), std::string::npos);
    EXPECT_THAT(read.error().message, HasSubstr("x.toml"));
  }
}

TEST_F(CalibrationFileTest, TheOldOneIsKeptAndSurvivesASpoiledNewOne) {
  ASSERT_TRUE(SaveCalibration(folder_, RandomCalibration(1)).ok());
  EXPECT_FALSE(LoadOldCalibration(folder_, "sim-1").ok());
  ASSERT_TRUE(SaveCalibration(folder_, RandomCalibration(2)).ok());
  Spoil(100);
  EXPECT_FALSE(LoadCalibration(folder_, "sim-1").ok());
  const auto old = LoadOldCalibration(folder_, "sim-1");
  ASSERT_TRUE(old.ok());
  ExpectSame(old->accel, RandomCalibration(1).accel);
  ASSERT_TRUE(SaveCalibration(folder_, RandomCalibration(3)).ok()) << "over a spoiled one";
  ExpectSame(LoadOldCalibration(folder_, "sim-1")->accel, RandomCalibration(1).accel);
  EXPECT_FALSE(std::filesystem::exists(folder_ / "sim-1.toml.new"));
}

TEST_F(CalibrationFileTest, AnotherSensorsFileIsRefused) {
  ASSERT_TRUE(SaveCalibration(folder_, RandomCalibration(1, "other")).ok());
  std::filesystem::rename(folder_ / "other.toml", folder_ / "sim-1.toml");
  EXPECT_THAT(LoadCalibration(folder_, "sim-1").error().message,
              HasSubstr("is of sensor other, expected sim-1"));
  EXPECT_EQ(LoadCalibration(folder_, "nobody").error().code, ErrorCode::kNotFound);
}

TEST_F(CalibrationFileTest, WrongKeysAndValuesAreNamed) {
  const std::string end = "\n[end]\nwhole = true\n";
  const auto message = [&](const std::string& toml) {
    return CalibrationFromToml(toml + end, "x.toml").error().message;
  };
  EXPECT_THAT(message("[sensor]\nformat = 1\n"), HasSubstr("sensor.serial is missing"));
  EXPECT_THAT(message("[sensor]\nserial = \"a\"\nformat = 2\n"), HasSubstr("sensor.format"));
  EXPECT_THAT(message("[sensor]\nserial = \"a\"\ncolour = 2\n"), HasSubstr("sensor.colour"));
  EXPECT_THAT(message("[sensor]\nserial = \"a\"\n[mag]\nmatrix = [1, 2]\noffset_tesla = [0, 0, 0]"),
              HasSubstr("mag.matrix must be a list of 9 numbers"));
  EXPECT_THAT(message("[sensor]\nserial = \"a\"\n[mag]\noffset_tesla = [0, 0, 0]"),
              HasSubstr("mag.matrix is missing"));
  EXPECT_THAT(
      message(
          "[sensor]\nserial = \"a\"\n[mag]\nmatrix = [0,0,0,0,0,0,0,0,0]\noffset_tesla = [0,0,0]"),
      HasSubstr("x.toml: mag.matrix must have a determinant"));
}

TEST_F(CalibrationFileTest, AFolderThatCannotBeMadeIsRefused) {
  std::ofstream(folder_ / "file") << "x";
  const Status saved = SaveCalibration(folder_ / "file" / "deeper", RandomCalibration(1));
  ASSERT_FALSE(saved.ok());
  EXPECT_EQ(saved.error().code, ErrorCode::kUnavailable);
}

TEST(CalibrationFileNameTest, LeavesTheFolderByNoSerial) {
  EXPECT_EQ(CalibrationFileName("00B42279"), "00B42279.toml");
  EXPECT_EQ(CalibrationFileName("../a b"), "%2E.%2Fa%20b.toml");
}

}  // namespace
}  // namespace limbcast::gateway
