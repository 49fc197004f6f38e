#include "common/units/frames.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include "common/math/rotation.hpp"

namespace limbcast::units {
namespace {

using Eigen::Quaterniond;
using Eigen::Vector3d;

TEST(FramesTest, NorthEastDownBecomeYXMinusZ) {
  EXPECT_EQ(EnuFromNed(Vector3d(1, 0, 0)), Vector3d(0, 1, 0));
  EXPECT_EQ(EnuFromNed(Vector3d(0, 1, 0)), Vector3d(1, 0, 0));
  EXPECT_EQ(EnuFromNed(Vector3d(0, 0, 1)), Vector3d(0, 0, -1));
}

TEST(FramesTest, TheQuaternionDoesWhatTheVectorFunctionDoes) {
  const Vector3d v_ned(0.3, -1.2, 2.5);
  EXPECT_LT((QuaternionEnuNed() * v_ned - EnuFromNed(v_ned)).norm(), 1e-15);
}

TEST(FramesTest, ThereAndBackIsTheSame) {
  const Vector3d v(0.3, -1.2, 2.5);
  EXPECT_EQ(NedFromEnu(EnuFromNed(v)), v);
  const Quaterniond q = math::ExpSO3({0.4, -1.1, 2.0});
  EXPECT_LT(math::AngleBetween_rad(NedFromEnu(EnuFromNed(q)), q), 1e-15);
}

TEST(FramesTest, AnOrientationInEnuTurnsVectorsIntoEnu) {
  const Quaterniond q_ned_sensor = math::ExpSO3({0.4, -1.1, 2.0});
  const Vector3d v_sensor(1.0, 2.0, 3.0);
  EXPECT_LT(
      (EnuFromNed(q_ned_sensor) * v_sensor - EnuFromNed(Vector3d(q_ned_sensor * v_sensor))).norm(),
      1e-14);
}

TEST(FramesTest, WithEastDeclinationMagneticNorthPointsEastOfTrueNorth) {
  const double declination_rad = 0.1;
  const Vector3d north_in_true =
      TrueFromMagneticNorth(Quaterniond::Identity(), declination_rad) * Vector3d::UnitY();
  EXPECT_NEAR(north_in_true.x(), std::sin(declination_rad), 1e-15);
  EXPECT_NEAR(north_in_true.y(), std::cos(declination_rad), 1e-15);
}

TEST(FramesTest, ViewerUpIsUpAndForwardIsNorth) {
  EXPECT_EQ(EnuFromViewer(Vector3d(0, 1, 0)), Vector3d(0, 0, 1));
  EXPECT_EQ(EnuFromViewer(Vector3d(0, 0, -1)), Vector3d(0, 1, 0));
  EXPECT_EQ(EnuFromViewer(Vector3d(1, 0, 0)), Vector3d(1, 0, 0));
  const Vector3d v(0.3, -1.2, 2.5);
  EXPECT_EQ(ViewerFromEnu(EnuFromViewer(v)), v);
}

TEST(AxisMapTest, DefaultMovesNothing) {
  const Vector3d v(1.0, 2.0, 3.0);
  EXPECT_EQ(AxisMap().Apply(v), v);
}

TEST(AxisMapTest, TakesTheNamedAxisWithItsSign) {
  const auto map = AxisMap::Parse("y-xz");
  ASSERT_TRUE(map.ok());
  EXPECT_EQ(map->Apply(Vector3d(1, 2, 3)), Vector3d(2, -1, 3));
  EXPECT_EQ(map->Apply(Eigen::Vector3f(1, 2, 3)), Eigen::Vector3f(2, -1, 3));
  EXPECT_EQ(map->matrix() * Vector3d(1, 2, 3), Vector3d(2, -1, 3));
}

TEST(AxisMapTest, RefusesWhatIsNotARightHandedMapAndSaysWhy) {
  for (const char* text : {"", "xy", "xyzx", "abc", "+x+y", "x y z", "--xyz", "xy+"}) {
    EXPECT_FALSE(AxisMap::Parse(text).ok()) << text;
  }
  const auto mirrored = AxisMap::Parse("xy-z");
  ASSERT_FALSE(mirrored.ok());
  EXPECT_NE(mirrored.error().message.find("left-handed"), std::string::npos);
  const auto twice = AxisMap::Parse("xxz");
  ASSERT_FALSE(twice.ok());
  EXPECT_NE(twice.error().message.find("twice"), std::string::npos);
}

}  // namespace
}  // namespace limbcast::units
