#include "common/sensing/sensor_calibration.hpp"

#include <gtest/gtest.h>

#include <limits>

namespace limbcast::sensing {
namespace {

TriadFit Doubling() {
  TriadFit fit;
  fit.calibration.matrix = 2.0 * Eigen::Matrix3d::Identity();
  fit.calibration.offset = {1.0, 0.0, 0.0};
  return fit;
}

TEST(SensorCalibrationTest, AppliesMatrixToReadingMinusOffset) {
  SensorCalibration calibration;
  calibration.gyro = Doubling();
  MargSample sample;
  sample.gyro_rad_s = {1.5F, 2.0F, 3.0F};
  sample.accel_m_s2 = {1.0F, 2.0F, 3.0F};
  calibration.Apply(sample);
  EXPECT_EQ(sample.gyro_rad_s, Eigen::Vector3f(1.0F, 4.0F, 6.0F));
  EXPECT_EQ(sample.accel_m_s2, Eigen::Vector3f(1.0F, 2.0F, 3.0F)) << "no fit, no change";
}

TEST(SensorCalibrationTest, AMissingReadingStaysZero) {
  SensorCalibration calibration;
  calibration.mag = Doubling();
  MargSample sample;
  sample.flags = kMagMissing;
  calibration.Apply(sample);
  EXPECT_EQ(sample.mag_tesla, Eigen::Vector3f(0.0F, 0.0F, 0.0F));
}

TEST(SensorCalibrationTest, AReadingThatIsNotFiniteStaysSo) {
  SensorCalibration calibration;
  calibration.accel = Doubling();
  MargSample sample;
  sample.accel_m_s2 = {std::numeric_limits<float>::quiet_NaN(), 0.0F, 0.0F};
  calibration.Apply(sample);
  EXPECT_FALSE(sample.accel_m_s2.allFinite());
}

TEST(SensorCalibrationTest, SummaryNamesChannelsAndGrades) {
  SensorCalibration calibration;
  EXPECT_EQ(calibration.Summary(), "");
  calibration.gyro = Doubling();
  calibration.mag = Doubling();
  calibration.mag->sigma_scale = 0.0015;
  EXPECT_EQ(calibration.Summary(), "gyro good, mag fair");
  calibration.accel = Doubling();
  for (auto* fit : {&calibration.gyro, &calibration.accel, &calibration.mag}) {
    (*fit)->sigma_scale = 1.0;
  }
  EXPECT_LE(calibration.Summary().size(), 64U) << "bound of the wire type";
}

TEST(SensorCalibrationTest, ASingularMatrixIsRefusedByName) {
  SensorCalibration calibration;
  EXPECT_TRUE(Validate(calibration).ok());
  calibration.mag = Doubling();
  calibration.mag->calibration.matrix(2, 2) = 0.0;
  EXPECT_EQ(Validate(calibration).error().message,
            "mag.matrix must have a determinant in [0.1, 10], is 0.000000");
  calibration.mag->calibration.offset.x() = std::numeric_limits<double>::infinity();
  EXPECT_EQ(Validate(calibration).error().message, "mag has a number that is not finite");
}

}  // namespace
}  // namespace limbcast::sensing
