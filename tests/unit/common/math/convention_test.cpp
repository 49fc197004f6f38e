// The conventions of the project as assertions (design/style.md, section 2). When prose and this
// file disagree, this file is right.
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <numbers>

#include "common/math/rotation.hpp"

namespace limbcast::math {
namespace {

using Eigen::Quaterniond;
using Eigen::Vector3d;

constexpr double kQuarterTurn_rad = 0.5 * std::numbers::pi;
constexpr double kRounding = 1e-15;

TEST(ConventionTest, QuaternionsAreHamilton) {
  const Quaterniond i(0, 1, 0, 0);
  const Quaterniond j(0, 0, 1, 0);
  const Quaterniond k(0, 0, 0, 1);
  EXPECT_EQ((i * j).coeffs(), k.coeffs());
  EXPECT_EQ((j * k).coeffs(), i.coeffs());
  EXPECT_EQ((k * i).coeffs(), j.coeffs());
  EXPECT_EQ((i * i).w(), -1.0);
}

TEST(ConventionTest, ConstructorsTakeWFirstAndEigenStoresItLast) {
  const Quaterniond q(1, 2, 3, 4);
  EXPECT_EQ(q.w(), 1.0);
  EXPECT_EQ(q.vec(), Vector3d(2, 3, 4));
  EXPECT_EQ(q.coeffs(), Eigen::Vector4d(2, 3, 4, 1));
}

TEST(ConventionTest, RotationsAreRightHanded) {
  const Vector3d turned = ExpSO3({0.0, 0.0, kQuarterTurn_rad}) * Vector3d::UnitX();
  EXPECT_LT((turned - Vector3d::UnitY()).norm(), kRounding);
}

TEST(ConventionTest, OrientationOfTheSensorInTheEarthFrameTurnsSensorCoordinatesIntoEarth) {
  // A sensor lying flat whose x axis points north: its x axis is earth y in ENU.
  const Quaterniond q_earth_sensor = ExpSO3({0.0, 0.0, kQuarterTurn_rad});
  const Vector3d x_of_sensor_in_earth = q_earth_sensor * Vector3d::UnitX();
  EXPECT_LT((x_of_sensor_in_earth - Vector3d::UnitY()).norm(), kRounding);
  EXPECT_LT((q_earth_sensor.toRotationMatrix() * Vector3d::UnitX() - x_of_sensor_in_earth).norm(),
            kRounding);
}

TEST(ConventionTest, NeighbouringFramesCancel) {
  const Quaterniond q_earth_sensor = ExpSO3({0.3, -0.7, 1.9});
  const Quaterniond q_sensor_segment = ExpSO3({-1.1, 0.2, 0.4});
  const Quaterniond q_earth_segment = q_earth_sensor * q_sensor_segment;
  const Vector3d v_segment(1.0, -2.0, 0.5);
  EXPECT_LT((q_earth_segment * v_segment - q_earth_sensor * (q_sensor_segment * v_segment)).norm(),
            4.0 * kRounding);
}

TEST(ConventionTest, RateInSensorAxesMultipliesOnTheRightAndInEarthAxesOnTheLeft) {
  const Quaterniond q_earth_sensor = ExpSO3({0.3, -0.7, 1.9});
  const Vector3d w_in_sensor_rad_s(0.5, -1.0, 2.0);
  const double dt_s = 0.01;
  const Quaterniond by_sensor = q_earth_sensor * ExpSO3(w_in_sensor_rad_s * dt_s);
  const Quaterniond by_earth = ExpSO3((q_earth_sensor * w_in_sensor_rad_s) * dt_s) * q_earth_sensor;
  EXPECT_LT((by_sensor.coeffs() - by_earth.coeffs()).norm(), 4.0 * kRounding);
}

TEST(ConventionTest, EarthIsEastNorthUp) {
  // At rest and flat, the accelerometer reads +g upward; gravity itself points to −z.
  const Vector3d east = Vector3d::UnitX();
  const Vector3d north = Vector3d::UnitY();
  EXPECT_EQ(east.cross(north), Vector3d::UnitZ());
}

TEST(ConventionTest, QAndMinusQAreOneOrientation) {
  const Quaterniond q = ExpSO3({0.3, -0.7, 1.9});
  const Quaterniond minus_q(-q.w(), -q.x(), -q.y(), -q.z());
  EXPECT_EQ(AngleBetween_rad(q, minus_q), 0.0);
  EXPECT_GE(Canonical(minus_q).w(), 0.0);
  EXPECT_EQ(Canonical(minus_q).coeffs(), Canonical(q).coeffs());
  EXPECT_EQ(NearestSign(minus_q, q).coeffs(), q.coeffs());
}

TEST(ConventionTest, HeadingIsCounterClockwiseFromEast) {
  EXPECT_NEAR(Heading_rad(ExpSO3({0.0, 0.0, 0.25})), 0.25, kRounding);
  const Quaterniond tilted = ExpSO3({0.0, 0.0, 0.25}) * ExpSO3({0.4, -0.3, 0.0});
  EXPECT_NEAR(Heading_rad(tilted), 0.25, 4.0 * kRounding);
}

TEST(ConventionTest, SkewIsTheCrossProductFromTheLeft) {
  const Vector3d a(1.0, 2.0, 3.0);
  const Vector3d b(-2.0, 0.5, 4.0);
  EXPECT_EQ(Skew(a) * b, a.cross(b));
}

}  // namespace
}  // namespace limbcast::math
