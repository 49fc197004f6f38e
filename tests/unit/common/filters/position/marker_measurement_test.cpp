#include "common/filters/position/marker_measurement.hpp"

#include <gtest/gtest.h>

namespace limbcast::filters {
namespace {

using namespace optical;
using Eigen::Vector3d;

const Vector3d kRate(1.5, -2.0, 3.0);
const Vector3d kAccel(4.0, -3.0, 2.0);

OpticalInertialState SomeState() {
  OpticalInertialState x;
  x.navigation.p_earth_sensor_m = {0.3, 0.2, 1.0};
  x.navigation.v_earth_sensor_m_s = {0.5, -1.0, 0.3};
  x.navigation.q_earth_sensor = math::ExpSO3({0.4, -0.7, 1.2});
  x.p_sensor_marker_m = {0.02, -0.01, 0.03};
  x.marker_lead_s = 0.006;
  return x;
}

TEST(MarkerMeasurementTest, EveryColumnOfHAgreesWithDifferences) {
  const OpticalInertialState x = SomeState();
  for (const double stamp_s : {0.0, 0.002, -0.003}) {
    const MarkerPrediction predicted = PredictMarker(x, kRate, kAccel, stamp_s);
    constexpr double kStep = 1e-5;
    for (int column = 0; column < kStates; ++column) {
      const auto at = [&](double step) {
        OpticalInertialState moved = x;
        Inject(ErrorVector::Unit(column) * step, moved);
        // The rate is corrected by the state's gyro bias: w = w_m − b_g.
        const Vector3d rate = kRate - (moved.errors.gyro_bias_rad_s - x.errors.gyro_bias_rad_s);
        return PredictMarker(moved, rate, kAccel, stamp_s).p_earth_marker_m;
      };
      const Vector3d difference = (at(kStep) - at(-kStep)) / (2.0 * kStep);
      EXPECT_LT((difference - predicted.H.col(column)).norm(), 1e-8) << column;
    }
  }
}

TEST(MarkerMeasurementTest, IsTheMarkerAtTheTimeItsStampMeans) {
  // A sensor at constant rate and acceleration: where the marker is 6 ms later.
  const OpticalInertialState x = SomeState();
  const MarkerPrediction predicted = PredictMarker(x, kRate, kAccel, 0.0);
  const double t = x.marker_lead_s;
  const Vector3d later =
      x.navigation.p_earth_sensor_m + t * x.navigation.v_earth_sensor_m_s + 0.5 * t * t * kAccel +
      x.navigation.q_earth_sensor * math::ExpSO3(kRate * t) * x.p_sensor_marker_m;
  EXPECT_LT((predicted.p_earth_marker_m - later).norm(), 0.5 * t * t * 15.0 * 0.04);
}

TEST(MarkerMeasurementTest, NoiseGrowsWithSpeed) {
  EXPECT_DOUBLE_EQ(MarkerVariance(3e-4, 2e-4, {2.0, 0.0, 0.0}), 9e-8 + 16e-8);
}

TEST(MarkerMeasurementTest, DifferenceIsTheInverseOfInject) {
  const OpticalInertialState x = SomeState();
  ErrorVector d;
  for (int i = 0; i < kStates; ++i) {
    d[i] = 0.01 * (i + 1) * (i % 2 == 0 ? 1.0 : -1.0);
  }
  OpticalInertialState moved = x;
  Inject(d, moved);
  EXPECT_LT((Difference(moved, x) - d).norm(), 1e-12);
}

}  // namespace
}  // namespace limbcast::filters
