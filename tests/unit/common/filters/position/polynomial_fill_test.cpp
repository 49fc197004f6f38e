#include "common/filters/position/polynomial_fill.hpp"

#include <gtest/gtest.h>

#include <vector>

namespace limbcast::filters {
namespace {

using Eigen::Vector3d;

Time At(double t_s) { return Time{} + DurationFromSeconds(t_s); }
Vector3d Parabola(double t) { return {1.0 + t, 2.0 * t * t, 0.5 - t + t * t}; }

std::vector<SeenMarker> ParabolaWithGap() {
  std::vector<SeenMarker> markers;
  for (int i = 0; i <= 100; ++i) {
    const double t = 0.01 * i;
    if (t < 0.455 || t > 0.545) {
      markers.push_back({At(t), Parabola(t)});
    }
  }
  return markers;
}

TEST(PolynomialFillTest, EndsOfAParabolaAreExact) {
  const auto markers = ParabolaWithGap();
  const auto from = FitGapEnd(markers, At(0.45), true);
  const auto to = FitGapEnd(markers, At(0.55), false);
  ASSERT_TRUE(from && to);
  EXPECT_LT((from->p_m - Parabola(0.45)).norm(), 1e-9);
  EXPECT_LT((from->v_m_s - Vector3d(1.0, 1.8, -0.1)).norm(), 1e-7);
  EXPECT_LT((to->v_m_s - Vector3d(1.0, 2.2, 0.1)).norm(), 1e-7);
  for (const double t : {0.45, 0.48, 0.5, 0.53, 0.55}) {
    EXPECT_LT((HermiteFill(*from, *to, At(t)) - Parabola(t)).norm(), 1e-9) << t;
  }
}

TEST(PolynomialFillTest, FewMarkersGiveALineOneGivesItself) {
  const std::vector<SeenMarker> two = {{At(0.0), {0, 0, 0}}, {At(0.1), {0.1, 0, 0}}};
  EXPECT_LT((FitGapEnd(two, At(0.1), true)->v_m_s - Vector3d(1.0, 0, 0)).norm(), 1e-9);
  EXPECT_EQ(FitGapEnd(two, At(0.0), true)->v_m_s.norm(), 0.0);
  EXPECT_FALSE(FitGapEnd(two, At(0.5), true).has_value());
  EXPECT_FALSE(FitGapEnd(std::vector<SeenMarker>{}, At(0.5), false).has_value());
}

}  // namespace
}  // namespace limbcast::filters
