#include "common/units/units.hpp"

#include <gtest/gtest.h>

#include <Eigen/Core>
#include <numbers>

namespace limbcast::units {
namespace {

static_assert(RadFromDeg(180.0) == std::numbers::pi);

TEST(UnitsTest, DegreesAndRadiansAreInverse) {
  EXPECT_DOUBLE_EQ(RadFromDeg(90.0), std::numbers::pi / 2.0);
  EXPECT_DOUBLE_EQ(DegFromRad(std::numbers::pi / 6.0), 30.0);
  EXPECT_DOUBLE_EQ(DegFromRad(RadFromDeg(123.456)), 123.456);
}

TEST(UnitsTest, OneGIsStandardGravity) {
  EXPECT_DOUBLE_EQ(MetresPerS2FromG(1.0), 9.80665);
  EXPECT_DOUBLE_EQ(GFromMetresPerS2(9.80665), 1.0);
}

TEST(UnitsTest, MagneticUnitsMeetInTesla) {
  EXPECT_DOUBLE_EQ(TeslaFromMicrotesla(50.0), 50e-6);
  EXPECT_DOUBLE_EQ(MicroteslaFromTesla(50e-6), 50.0);
  EXPECT_DOUBLE_EQ(TeslaFromGauss(0.5), 50e-6);
}

TEST(UnitsTest, MillimetresAreThousandths) { EXPECT_DOUBLE_EQ(MetresFromMillimetres(1500.0), 1.5); }

TEST(UnitsTest, VectorsAreConvertedByElementInTheirOwnPrecision) {
  const Eigen::Vector3f rate_rad_s = RadFromDeg(Eigen::Vector3f(180.0F, -90.0F, 0.0F));
  EXPECT_FLOAT_EQ(rate_rad_s.x(), std::numbers::pi_v<float>);
  EXPECT_FLOAT_EQ(rate_rad_s.y(), -0.5F * std::numbers::pi_v<float>);
  EXPECT_EQ(rate_rad_s.z(), 0.0F);
  const Eigen::Vector3d accel_m_s2 = MetresPerS2FromG(Eigen::Vector3d(0.0, 0.0, 2.0));
  EXPECT_DOUBLE_EQ(accel_m_s2.z(), 19.6133);
}

}  // namespace
}  // namespace limbcast::units
