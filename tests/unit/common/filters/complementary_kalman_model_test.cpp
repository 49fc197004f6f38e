#include "common/filters/complementary_kalman_model.hpp"

#include <gtest/gtest.h>

#include <random>

#include "common/math/rotation.hpp"

namespace limbcast::filters {
namespace {

using Eigen::Quaterniond;
using Eigen::Vector3d;

Vector3d Random(std::mt19937& rng, double sigma) {
  std::normal_distribution<double> normal(0.0, sigma);
  return {normal(rng), normal(rng), normal(rng)};
}

TEST(ComplementaryKalmanModelTest, MeasurementMatrixMatchesFiniteDifferences) {
  std::mt19937 rng(31);
  constexpr double kStep = 1e-6;
  for (int trial = 0; trial < 20; ++trial) {
    const Quaterniond q_ES = math::ExpSO3(Random(rng, 2.0));
    const Vector3d m_E = Vector3d(0.0, 0.4, -0.9);
    const Vector3d d_E = Random(rng, 0.5);
    // z of errors x: truth minus what the estimate predicts, with θ and d turned as the filter
    // does.
    const auto z_of = [&](const Vector9& x) {
      const Quaterniond q_estimate = q_ES * math::ExpSO3(x.head<3>());
      const Vector3d d_estimate_E = d_E + q_ES * x.tail<3>();
      Eigen::Matrix<double, 6, 1> z;
      z.head<3>() =
          q_ES.conjugate() * Vector3d::UnitZ() - q_estimate.conjugate() * Vector3d::UnitZ();
      z.tail<3>() = q_ES.conjugate() * (m_E + d_E) - q_estimate.conjugate() * (m_E + d_estimate_E);
      return z;
    };
    const Matrix69 C = ComplementaryMeasurementMatrix(
        q_ES.conjugate() * Vector3d::UnitZ(), q_ES.conjugate() * m_E, q_ES.conjugate() * d_E);
    for (int i = 0; i < 9; ++i) {
      const Vector9 step = kStep * Vector9::Unit(i);
      EXPECT_LT((C.col(i) - (z_of(step) - z_of(-step)) / (2.0 * kStep)).norm(), 1e-9);
    }
  }
}

TEST(ComplementaryKalmanModelTest, TransitionMatchesFiniteDifferences) {
  std::mt19937 rng(32);
  constexpr double kStep = 1e-6;
  const double dt_s = 0.01;
  const double c_d = 0.97;
  for (int trial = 0; trial < 20; ++trial) {
    const Quaterniond q = math::ExpSO3(Random(rng, 2.0));
    const Vector3d w_S = Random(rng, 0.5);
    // Errors after one step of truth and estimate side by side; d in sensor axes of each instant.
    const auto after = [&](const Vector9& x) {
      const Quaterniond q_true = q * math::ExpSO3(w_S * dt_s);
      const Vector3d w_estimate = w_S - x.segment<3>(3);
      const Quaterniond q_estimate =
          q * math::ExpSO3(x.head<3>()) * math::ExpSO3(w_estimate * dt_s);
      const Vector3d d_error_E = c_d * (q * x.tail<3>());
      Vector9 out;
      out.head<3>() = math::LogSO3(q_true.conjugate() * q_estimate);
      out.segment<3>(3) = x.segment<3>(3);
      out.tail<3>() = q_true.conjugate() * d_error_E;
      return out;
    };
    const Matrix9 F = ComplementaryTransition(w_S, dt_s, c_d);
    for (int i = 0; i < 9; ++i) {
      const Vector9 step = kStep * Vector9::Unit(i);
      // F_θb = −T I leaves out the turn within the step, at most |ω| T²/2.
      EXPECT_LT((F.col(i) - (after(step) - after(-step)) / (2.0 * kStep)).norm(),
                1e-8 + w_S.norm() * dt_s * dt_s);
    }
  }
}

TEST(ComplementaryKalmanModelTest, BlockwisePropagationIsFPFt) {
  std::mt19937 rng(33);
  std::normal_distribution<double> normal;
  const Matrix9 root =
      Matrix9::NullaryExpr([&](Eigen::Index, Eigen::Index) { return normal(rng); });
  const Matrix9 P = root * root.transpose();
  const Vector3d w_S(3.0, -20.0, 7.0);
  const Matrix9 F = ComplementaryTransition(w_S, 0.02, 0.9);
  EXPECT_LT((PropagateFull(P, w_S, 0.02, 0.9) - F * P * F.transpose()).norm(), 1e-12 * P.norm());
}

TEST(ComplementaryKalmanModelTest, ThesisStructureKeepsTheBlocksOnly) {
  const Matrix9 P = Matrix9::Constant(0.1) + 0.5 * Matrix9::Identity();
  const Matrix9 out = PropagateBlocks(P, 0.01, 0.9);
  EXPECT_TRUE((out.block<6, 3>(0, 6).isZero()));
  EXPECT_EQ(out(0, 3), -0.01 * P(3, 3));
  EXPECT_DOUBLE_EQ(out(0, 0), P(0, 0) + 1e-4 * P(3, 3));
  EXPECT_DOUBLE_EQ(out(6, 6), 0.81 * P(6, 6));
  EXPECT_TRUE(out.isApprox(out.transpose()));
}

}  // namespace
}  // namespace limbcast::filters
