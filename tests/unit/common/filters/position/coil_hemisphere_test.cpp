#include "common/filters/position/coil_hemisphere.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace limbcast::filters {
namespace {

TEST(CoilHemisphereTest, TrackingTakesTheNearerOfTheTwo) {
  const HemisphereRule rule{.predicted_emitter_m = Eigen::Vector3d(0.0, 0.1, -0.3),
                            .half_space = Eigen::Vector3d::UnitZ()};
  EXPECT_EQ(HemisphereOf(rule, {0.0, 0.1, -0.4}), Hemisphere::kAsGiven);
  EXPECT_EQ(HemisphereOf(rule, {0.0, -0.1, 0.4}), Hemisphere::kOpposite);
}

TEST(CoilHemisphereTest, AStartIsInTheConfiguredHalf) {
  const HemisphereRule rule{.predicted_emitter_m = {}, .half_space = Eigen::Vector3d::UnitZ()};
  EXPECT_EQ(HemisphereOf(rule, {0.1, 0.0, 0.4}), Hemisphere::kAsGiven);
  EXPECT_EQ(HemisphereOf(rule, {0.1, 0.0, -0.4}), Hemisphere::kOpposite);
}

TEST(CoilHemisphereTest, AStartNearTheBoundaryIsUndecided) {
  const HemisphereRule rule{.predicted_emitter_m = {}, .half_space = Eigen::Vector3d::UnitZ()};
  EXPECT_EQ(HemisphereOf(rule, {std::cos(0.34), 0.0, std::sin(0.34)}), Hemisphere::kUndecided);
  EXPECT_EQ(HemisphereOf(rule, {std::cos(0.36), 0.0, std::sin(0.36)}), Hemisphere::kAsGiven);
  EXPECT_EQ(HemisphereOf({}, {0.1, 0.0, 0.4}), Hemisphere::kUndecided);
}

}  // namespace
}  // namespace limbcast::filters
