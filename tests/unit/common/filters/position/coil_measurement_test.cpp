#include "common/filters/position/coil_measurement.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "common/math/rotation.hpp"

namespace limbcast::filters {
namespace {

using Index = CoilInertialIndex;

CoilInertialState SomeState() {
  CoilInertialState state;
  state.p_earth_m = {0.12, -0.2, 0.25};
  state.q_earth_sensor = math::ExpSO3({0.3, -0.8, 1.4});
  state.q_earth_emitter = math::ExpSO3({-0.5, 0.2, 0.9});
  state.background_earth_tesla = {1e-6, 19e-6, -45e-6};
  state.gradient_earth_tesla_m = GradientOf({2e-6, -5e-6, 1e-6, 3e-6, -4e-6});
  state.emitter_mag_offset_tesla = {1e-7, -2e-7, 3e-7};
  state.emitter.accel_bias_m_s2 = {0.02, -0.03, 0.01};
  return state;
}

TEST(CoilMeasurementTest, HMatchesDifferences) {
  const CoilInertialState state = SomeState();
  for (int coil = -1; coil <= sensing::kAllCoils; ++coil) {
    const sensing::CoilDrive drive{
        .coil = coil, .current_a = -1.5, .tones_a = {0.5, -0.3, 0.1}, .settled = true};
    const CoilPrediction at = PredictCoilSample({}, drive, state);
    for (int i = 0; i < Index::kAll; ++i) {
      const double h = i >= Index::kBackground ? 1e-9 : 1e-5;
      const CoilVector step = h * CoilVector::Unit(i);
      const Eigen::Vector3d expected =
          (PredictCoilSample({}, drive, Plus(state, step)).field_tesla -
           PredictCoilSample({}, drive, Plus(state, -step)).field_tesla) /
          (2.0 * h);
      EXPECT_LT((at.H.col(i) - expected).norm(), 1e-6 * at.H.col(i).norm() + 1e-13)
          << "coil " << coil << " element " << i;
    }
  }
}

TEST(CoilMeasurementTest, TurningEverythingTogetherChangesNothing) {
  const CoilInertialState state = SomeState();
  const sensing::CoilDrive drive{.coil = 1, .current_a = 1.5, .settled = true};
  const CoilPrediction at = PredictCoilSample({}, drive, state);
  const Eigen::Vector3d turn(0.4, -0.7, 0.2);
  CoilVector error = CoilVector::Zero();
  error.segment<3>(Index::kP) = turn.cross(state.p_earth_m);
  error.segment<3>(Index::kSensorTheta) = turn;
  error.segment<3>(Index::kEmitterTheta) = turn;
  error.segment<3>(Index::kBackground) = turn.cross(state.background_earth_tesla);
  const Eigen::Matrix3d& G = state.gradient_earth_tesla_m;
  error.segment<5>(Index::kGradient) =
      GradientElements(math::Skew(turn) * G - G * math::Skew(turn));
  EXPECT_LT((at.H * error).norm(), 1e-18);
}

TEST(CoilMeasurementTest, TheSourcesOwnMagnetometerFeelsTheFieldWhereItIs) {
  const CoilInertialState state = SomeState();
  MeasurementRecord<Index::kAll, 3> at;
  const Eigen::Vector3d field_M = state.q_earth_emitter.conjugate() * state.background_earth_tesla;
  PredictEmitterSample(state, field_M + state.emitter_mag_offset_tesla, at);
  EXPECT_LT(at.nu.norm(), 1e-18);
  MeasurementRecord<Index::kAll, 3> moved;
  for (int i = 0; i < Index::kAll; ++i) {
    const double h = i >= Index::kBackground ? 1e-9 : 1e-6;
    PredictEmitterSample(Plus(state, h * CoilVector::Unit(i)), field_M, moved);
    PredictEmitterSample(state, field_M, at);
    EXPECT_LT((at.H.col(i) + (moved.nu - at.nu) / h).norm(), 1e-6 * at.H.col(i).norm() + 1e-10)
        << i;
  }
}

TEST(CoilMeasurementTest, GaugesMatchDifferences) {
  const CoilInertialState state = SomeState();
  const Eigen::Vector3d accel_m_s2(1.0, -2.0, 9.0);
  MeasurementRecord<Index::kAll, 3> at;
  MeasurementRecord<Index::kAll, 3> moved;
  const double h = 1e-6;
  GravityGauge(state, accel_m_s2, at);
  for (int i = 0; i < Index::kAll; ++i) {
    GravityGauge(Plus(state, h * CoilVector::Unit(i)), accel_m_s2, moved);
    EXPECT_LT((at.H.col(i) + (moved.nu - at.nu) / h).norm(), 1e-4) << i;
  }
  BackgroundGauge(state, {2e-6, 19e-6, -45e-6}, at);
  EXPECT_NEAR(at.nu.x(), 1e-6, 1e-15);
  EXPECT_EQ(at.H.middleCols<3>(Index::kBackground), Eigen::Matrix3d::Identity());
}

TEST(CoilMeasurementTest, HOfAPoseMatchesDifferences) {
  const CoilInertialState state = SomeState();
  const double h = 1e-6;
  CoilPoseRecord at;
  PoseOfBurst(state, state.p_emitter_sensor_m(), state.q_sensor_emitter().toRotationMatrix(), at);
  EXPECT_LT(at.nu.norm(), 1e-15);
  for (int i = 0; i < Index::kAll; ++i) {
    // What a burst without noise would say if the error were h in this element.
    const CoilInertialState truth = Plus(state, h * CoilVector::Unit(i));
    CoilPoseRecord moved;
    PoseOfBurst(state, truth.p_emitter_sensor_m(), truth.q_sensor_emitter().toRotationMatrix(),
                moved);
    EXPECT_LT((at.H.col(i) - moved.nu / h).norm(), 1e-5) << i;
  }
}

TEST(CoilMeasurementTest, ACurrentIsWrongBeyondFivePercentOrWhenNotStated) {
  const double nan = std::nan("");
  const auto wrong = [](int coil, double stated_a, double measured_a) {
    return IsCurrentWrong({.coil = coil, .current_a = stated_a, .measured_a = measured_a});
  };
  EXPECT_FALSE(wrong(0, -1.5, -1.43));
  EXPECT_TRUE(wrong(0, -1.5, -1.42));
  EXPECT_TRUE(wrong(0, -1.5, 1.5));
  EXPECT_FALSE(wrong(0, 1.5, nan)) << "nobody measured it";
  EXPECT_FALSE(wrong(-1, 0.0, 0.2)) << "no coil is on";
  EXPECT_TRUE(wrong(0, nan, nan));
  EXPECT_TRUE(
      IsCurrentWrong({.coil = sensing::kAllCoils, .current_a = 0.7, .tones_a = {0.1, nan, 0.0}}));
}

}  // namespace
}  // namespace limbcast::filters
