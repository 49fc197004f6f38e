#include "common/filters/position/position_series.hpp"

#include <gtest/gtest.h>

#include <vector>

#include "common/math/rotation.hpp"

namespace limbcast::filters {
namespace {

using Eigen::Vector3d;

Time At(double t_s) { return Time{} + DurationFromSeconds(t_s); }
Vector3d Path(double t) { return {t * t, 1.0 + t, 0.0}; }

PositionEstimate Epoch(double t, FillKind fill) {
  PositionEstimate e;
  e.at = At(t);
  e.fill = fill;
  e.p_earth_sensor_m = Path(t);
  e.v_earth_sensor_m_s = {2.0 * t, 1.0, 0.0};
  e.p_earth_marker_m = e.p_earth_sensor_m + Vector3d(0.0, 0.0, 0.02);
  e.q_earth_sensor = math::ExpSO3({0.0, 0.0, t});
  e.cov_position_m2 = 1e-6 * Eigen::Matrix3d::Identity();
  return e;
}

TEST(PositionSeriesTest, RowsBetweenEpochsFollowTheCurve) {
  const std::vector<PositionEstimate> epochs = {Epoch(0.50, FillKind::kMeasured),
                                                Epoch(0.51, FillKind::kMeasured)};
  const std::vector<Time> rows = {At(0.50), At(0.504), At(0.51)};
  const auto series = SeriesAt(epochs, rows, {});
  ASSERT_EQ(series.size(), 3U);
  EXPECT_EQ(series[0].fill, FillKind::kMeasured);
  EXPECT_EQ(series[1].fill, FillKind::kInertialSmoothed);
  EXPECT_EQ(series[2].fill, FillKind::kMeasured);
  EXPECT_LT((series[1].p_earth_sensor_m - Path(0.504)).norm(), 1e-12);
  EXPECT_LT((series[1].p_earth_marker_m - Path(0.504) - Vector3d(0, 0, 0.02)).norm(), 1e-12);
  EXPECT_NEAR(math::Heading_rad(series[1].q_earth_sensor), 0.504, 1e-9);
}

TEST(PositionSeriesTest, WithoutInertialReadingsShortGapsAreAPolynomial) {
  const std::vector<PositionEstimate> epochs = {Epoch(0.50, FillKind::kMeasured),
                                                Epoch(0.90, FillKind::kMeasured)};
  std::vector<SeenMarker> markers;
  for (int i = 40; i <= 100; ++i) {
    if (i < 60 || i > 65) {
      markers.push_back({At(0.01 * i), Path(0.01 * i)});
    }
  }
  const std::vector<Time> rows = {At(0.3), At(0.45), At(0.625), At(0.70)};
  const auto series = SeriesAt(epochs, rows, markers);
  EXPECT_EQ(series[0].fill, FillKind::kNone);
  EXPECT_EQ(series[1].fill, FillKind::kMeasured);  // before all epochs, but seen
  EXPECT_EQ(series[2].fill, FillKind::kPolynomial);
  EXPECT_LT((series[2].p_earth_marker_m - Path(0.625)).norm(), 1e-6);
  EXPECT_GT(series[2].sigma_position_m(), 1e-3);
  EXPECT_EQ(series[3].fill, FillKind::kMeasured);
  // Markers too far apart as well: what inertia had is better than nothing.
  const std::vector<Time> far = {At(0.7)};
  EXPECT_EQ(SeriesAt(epochs, far, {}).front().fill, FillKind::kInertialSmoothed);
}

}  // namespace
}  // namespace limbcast::filters
