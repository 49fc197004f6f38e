#include "common/filters/position/optical_outputs.hpp"

#include <gtest/gtest.h>

#include "tests/unit/common/filters/position/optical_scene.hpp"

namespace limbcast::filters {
namespace {

using namespace optical;

// The outputs of a state, computed anew: what Correct must do to first order.
PositionEstimate OutputsOf(OpticalEpoch epoch, const InertialReading& raw, const ErrorVector& d) {
  Inject(d, epoch.state);
  const InertialReading corrected = epoch.state.errors.Correct(raw);
  epoch.w_earth_sensor_in_sensor_rad_s = corrected.gyro_rad_s;
  epoch.accel_in_earth_m_s2 =
      epoch.state.navigation.q_earth_sensor * corrected.accel_m_s2 + epoch.state.g_in_earth_m_s2;
  return ForwardEstimate(epoch);
}

TEST(OpticalOutputsTest, RowsSayWhatACorrectionOfTheStateDoes) {
  test_support::OpticalSceneConfig config;
  config.motion_s = 6.0;
  const test_support::OpticalScene scene(config);
  OpticalInertialFilter filter{OpticalInertialConfig{}};
  std::size_t row = 0;
  for (; row < scene.rows(); ++row) {
    (void)test_support::FeedRow(filter, scene, row);
  }
  ASSERT_TRUE(filter.started());
  OpticalEpoch epoch = filter.epoch();
  const std::size_t at = scene.RowOf(epoch.at);
  const InertialReading raw{scene.samples[at].gyro_rad_s.cast<double>(),
                            scene.samples[at].accel_m_s2.cast<double>()};
  epoch.P.setIdentity();  // then rows·λ is C λ
  const OutputRows rows = OutputRowsOf(epoch);
  for (int column = 0; column < kStates; ++column) {
    const ErrorVector d = ErrorVector::Unit(column) * 1e-6;
    PositionEstimate corrected = ForwardEstimate(epoch);
    Correct(rows * d, corrected);
    const PositionEstimate anew = OutputsOf(epoch, raw, d);
    EXPECT_LT((corrected.p_earth_marker_m - anew.p_earth_marker_m).norm(), 1e-10) << column;
    EXPECT_LT((corrected.p_earth_sensor_m - anew.p_earth_sensor_m).norm(), 1e-10) << column;
    EXPECT_LT((corrected.v_earth_sensor_m_s - anew.v_earth_sensor_m_s).norm(), 1e-10) << column;
    EXPECT_LT((corrected.accel_in_earth_m_s2 - anew.accel_in_earth_m_s2).norm(), 1e-9) << column;
    EXPECT_LT(math::AngleBetween_rad(corrected.q_earth_sensor, anew.q_earth_sensor), 1e-9);
  }
}

TEST(OpticalOutputsTest, FillKindsHaveNames) {
  EXPECT_EQ(ToString(FillKind::kMeasured), "measured");
  EXPECT_EQ(ToString(FillKind::kPolynomial), "polynomial");
}

}  // namespace
}  // namespace limbcast::filters
