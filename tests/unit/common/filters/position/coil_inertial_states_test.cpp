#include "common/filters/position/coil_inertial_states.hpp"

#include <gtest/gtest.h>

#include <limits>

namespace limbcast::filters {
namespace {

TEST(CoilInertialStatesTest, MinusIsTheInverseOfPlus) {
  CoilInertialState state;
  state.q_earth_sensor = Eigen::Quaterniond(0.5, -0.5, 0.5, 0.5);
  const CoilVector error = 0.3 * CoilVector::LinSpaced(-1.0, 1.0);
  const CoilInertialState moved = Plus(state, error);
  EXPECT_LT((Minus(moved, state) - error).norm(), 1e-12);
  EXPECT_LT((Minus(Plus(state, Minus(moved, state)), moved)).norm(), 1e-12);
}

TEST(CoilInertialStatesTest, MatricesAreTakenByColumns) {
  CoilVector error = CoilVector::Zero();
  error[CoilInertialIndex::kSensorGyroMatrix + 1] = 0.01;
  error[CoilInertialIndex::kSensorAccelMatrix + 3] = 0.02;
  const CoilInertialState state = Plus({}, error);
  EXPECT_EQ(state.sensor.gyro_matrix(1, 0), 0.01);
  EXPECT_EQ(state.sensor.accel_matrix(0, 1), 0.02);
}

TEST(CoilInertialStatesTest, AGradientIsSymmetricWithoutTraceAndItsElementsGiveItBack) {
  const Eigen::Matrix<double, 5, 1> elements(1.0, -2.0, 3.0, 4.0, 5.0);
  const Eigen::Matrix3d G = GradientOf(elements);
  EXPECT_EQ(G, G.transpose());
  EXPECT_EQ(G.trace(), 0.0);
  EXPECT_EQ(GradientElements(G), elements);
  CoilInertialState state;
  state.p_earth_m = {0.0, 0.5, 0.0};
  state.background_earth_tesla = {1.0, 2.0, 3.0};
  state.gradient_earth_tesla_m = G;
  EXPECT_EQ(state.background_at_sensor_earth_tesla(), Eigen::Vector3d(2.5, 1.0, 5.5));
}

TEST(CoilInertialStatesTest, AVarianceOfItsOwnLeavesNoCovariance) {
  CoilCovariance P = CoilCovariance::Ones();
  SetMatrixVariance(P, CoilInertialIndex::kSensorGyroMatrix, 0.1);
  const auto own = P.middleRows<9>(CoilInertialIndex::kSensorGyroMatrix);
  EXPECT_NEAR(own.sum(), 9.0 * 0.01, 1e-12);
  EXPECT_NEAR(own.norm(), 3.0 * 0.01, 1e-12);
  EXPECT_EQ(P(0, 0), 1.0);
}

TEST(CoilInertialStatesTest, AttitudeErrorsAreInTheEarthFrame) {
  CoilInertialState state;
  state.q_earth_sensor = Eigen::AngleAxisd(1.5708, Eigen::Vector3d::UnitX());
  CoilVector error = CoilVector::Zero();
  error[CoilInertialIndex::kSensorTheta + 2] = 0.1;
  const Eigen::Vector3d x_E = Plus(state, error).q_earth_sensor * Eigen::Vector3d::UnitX();
  EXPECT_NEAR(x_E.y(), 0.0998, 1e-4);
}

TEST(CoilInertialStatesTest, OutputsAreRelativeToTheEmitter) {
  CoilInertialState state;
  state.p_earth_m = {0.0, 0.4, 0.0};
  state.q_earth_emitter = Eigen::AngleAxisd(0.5 * 3.14159265358979, Eigen::Vector3d::UnitZ());
  EXPECT_LT((state.p_emitter_sensor_m() - Eigen::Vector3d(0.4, 0.0, 0.0)).norm(), 1e-12);
  EXPECT_TRUE(state.IsFinite());
  state.v_earth_m_s.y() = std::numeric_limits<double>::quiet_NaN();
  EXPECT_FALSE(state.IsFinite());
  state.v_earth_m_s.setZero();
  state.sensor.gyro_matrix(2, 1) = std::numeric_limits<double>::infinity();
  EXPECT_FALSE(state.IsFinite());
}

}  // namespace
}  // namespace limbcast::filters
