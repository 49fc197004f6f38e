#include "common/units/viewer_axes.hpp"

#include <gtest/gtest.h>

#include <random>

namespace limbcast::units {
namespace {

using Eigen::Quaterniond;
using Eigen::Vector3d;

class ViewerAxesTest : public ::testing::TestWithParam<ViewerAxes> {};

TEST_P(ViewerAxesTest, RotatingAndChangingAxesCommute) {
  std::mt19937 rng(20240517);
  std::normal_distribution<double> normal;
  for (int trial = 0; trial < 100; ++trial) {
    const Quaterniond q =
        Quaterniond(normal(rng), normal(rng), normal(rng), normal(rng)).normalized();
    const Vector3d v(normal(rng), normal(rng), normal(rng));
    // q·v·q* holds in a left-handed system too when the components are taken as they stand.
    EXPECT_LT(
        (VectorIn(GetParam(), q * v) - RotationIn(GetParam(), q) * VectorIn(GetParam(), v)).norm(),
        1e-12);
  }
}
INSTANTIATE_TEST_SUITE_P(All, ViewerAxesTest,
                         ::testing::Values(ViewerAxes::kHouse, ViewerAxes::kOpenXr,
                                           ViewerAxes::kUnity, ViewerAxes::kGltf,
                                           ViewerAxes::kIsb));

TEST(ViewerAxesTableTest, ForwardLeftAndUpLieWhereTheViewersPutThem) {
  const Vector3d forward = Vector3d::UnitX();
  const Vector3d left = Vector3d::UnitY();
  const Vector3d up = Vector3d::UnitZ();
  EXPECT_EQ(VectorIn(ViewerAxes::kOpenXr, forward), -Vector3d::UnitZ());
  EXPECT_EQ(VectorIn(ViewerAxes::kOpenXr, left), -Vector3d::UnitX());
  EXPECT_EQ(VectorIn(ViewerAxes::kUnity, forward), Vector3d::UnitZ());
  EXPECT_EQ(VectorIn(ViewerAxes::kUnity, left), -Vector3d::UnitX());
  EXPECT_EQ(VectorIn(ViewerAxes::kGltf, forward), Vector3d::UnitZ());
  EXPECT_EQ(VectorIn(ViewerAxes::kGltf, left), Vector3d::UnitX());
  EXPECT_EQ(VectorIn(ViewerAxes::kIsb, forward), Vector3d::UnitX());
  EXPECT_EQ(VectorIn(ViewerAxes::kIsb, left), -Vector3d::UnitZ());
  for (const ViewerAxes axes :
       {ViewerAxes::kOpenXr, ViewerAxes::kUnity, ViewerAxes::kGltf, ViewerAxes::kIsb}) {
    EXPECT_EQ(VectorIn(axes, up), Vector3d::UnitY());
  }
}

TEST(ViewerAxesTableTest, VectorPartsAreThoseOfThePublishedTable) {
  const Quaterniond q(0.1, 0.2, 0.3, 0.4);  // components only; length does not matter
  const auto vec = [&](ViewerAxes axes) { return Vector3d(RotationIn(axes, q).vec()); };
  EXPECT_EQ(vec(ViewerAxes::kUnity), Vector3d(0.3, -0.4, -0.2));
  EXPECT_EQ(vec(ViewerAxes::kOpenXr), Vector3d(-0.3, 0.4, -0.2));
  EXPECT_EQ(vec(ViewerAxes::kGltf), Vector3d(0.3, 0.4, 0.2));
  EXPECT_EQ(vec(ViewerAxes::kIsb), Vector3d(0.2, 0.4, -0.3));
  EXPECT_EQ(RotationIn(ViewerAxes::kUnity, q).w(), 0.1);
}

}  // namespace
}  // namespace limbcast::units
