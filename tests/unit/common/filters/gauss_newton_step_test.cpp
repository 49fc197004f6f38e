#include "common/filters/gauss_newton_step.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <numbers>
#include <random>

#include "common/filters/gauss_newton_kernel.hpp"
#include "common/filters/two_vector_start.hpp"
#include "common/math/rotation.hpp"

namespace limbcast::filters {
namespace {

using Eigen::Matrix3d;
using Eigen::Quaterniond;
using Eigen::Vector3d;
using Eigen::Vector4d;

// The publications: NED, m down, n in the north-down plane.
const Vector3d kDown = Vector3d::UnitZ();
Vector3d FieldNed(double dip_deg) {
  const double dip = dip_deg * std::numbers::pi / 180.0;
  return {std::cos(dip), 0.0, std::sin(dip)};
}

Quaterniond RandomQuaternion(std::mt19937& rng) {
  std::normal_distribution<double> normal;
  return Quaterniond(normal(rng), normal(rng), normal(rng), normal(rng)).normalized();
}
Vector3d RandomUnit(std::mt19937& rng) {
  std::normal_distribution<double> normal;
  return Vector3d(normal(rng), normal(rng), normal(rng)).normalized();
}
Quaterniond Plus(const Quaterniond& q, const Vector4d& dq) {
  return Quaterniond(q.w() + dq[0], q.x() + dq[1], q.y() + dq[2], q.z() + dq[3]);
}
Quaterniond Times(const Quaterniond& q, const Vector3d& v) {
  return q * Quaterniond(0.0, v.x(), v.y(), v.z());
}
Vector4d Components(const Quaterniond& q) { return {q.w(), q.x(), q.y(), q.z()}; }
double ComponentError(const Quaterniond& a, const Quaterniond& b) {
  return std::min((Components(a) - Components(b)).norm(), (Components(a) + Components(b)).norm());
}

TEST(GaussNewtonStepTest, DegreeTwoJacobianMatchesFiniteDifferences) {
  std::mt19937 rng(11);
  for (int trial = 0; trial < 50; ++trial) {
    const Quaterniond q = RandomQuaternion(rng);
    const Vector3d n = FieldNed(60.0);
    const Matrix64 X = JacobianOfDegreeTwo(q, kDown, n);
    constexpr double kStep = 1e-6;
    for (int i = 0; i < 4; ++i) {
      const Vector4d step = kStep * Vector4d::Unit(i);
      const Vector6 numerical = (ComputedMeasurement(Plus(q, step), kDown, n) -
                                 ComputedMeasurement(Plus(q, -step), kDown, n)) /
                                (2.0 * kStep);
      EXPECT_LT((X.col(i) - numerical).norm(), 1e-9);
    }
    EXPECT_LT((X * Components(q) - 2.0 * ComputedMeasurement(q, kDown, n)).norm(), 1e-13);
  }
}

TEST(GaussNewtonStepTest, ReducedJacobianIsTheClosedFormAndTheRestrictionOfTheFullOne) {
  std::mt19937 rng(12);
  for (int trial = 0; trial < 50; ++trial) {
    const Quaterniond q = RandomQuaternion(rng);
    const Vector3d n = FieldNed(60.0);
    const Vector6 y = ComputedMeasurement(q, kDown, n);
    Eigen::Matrix<double, 6, 3> X_v;
    X_v << 2.0 * math::Skew(y.head<3>()), 2.0 * math::Skew(y.tail<3>());
    const Matrix64 X = JacobianOfDegreeTwo(q, kDown, n);
    for (int axis = 0; axis < 3; ++axis) {
      const Vector4d direction = Components(Times(q, Vector3d::Unit(axis)));
      EXPECT_LT((X * direction - X_v.col(axis)).norm(), 1e-13);
      // The same from the general (degree 0) quaternion: differences of the normalised one.
      constexpr double kStep = 1e-6;
      const Vector6 numerical =
          (ComputedMeasurement(Plus(q, kStep * direction).normalized(), kDown, n) -
           ComputedMeasurement(Plus(q, -kStep * direction).normalized(), kDown, n)) /
          (2.0 * kStep);
      EXPECT_LT((X_v.col(axis) - numerical).norm(), 1e-9);
    }
  }
}

TEST(GaussNewtonStepTest, ReducedStepSolvesTheWeightedNormalEquations) {
  std::mt19937 rng(13);
  for (const double rho : {0.2, 0.45, 1.0, 3.0}) {
    for (int trial = 0; trial < 50; ++trial) {
      const Vector3d h = RandomUnit(rng);
      const Vector3d b = RandomUnit(rng);
      const Vector3d h0 = RandomUnit(rng);
      const Vector3d b0 = RandomUnit(rng);
      Eigen::Matrix<double, 6, 3> X_v;
      X_v << 2.0 * math::Skew(h), 2.0 * rho * math::Skew(b);
      Vector6 epsilon;
      epsilon << h0 - h, rho * (b0 - b);
      const Vector3d solved = X_v.colPivHouseholderQr().solve(epsilon);
      EXPECT_LT((ReducedStep(h, b, h0, b0, rho) - solved).norm(), 1e-9 * (1.0 + solved.norm()));
    }
  }
}

TEST(GaussNewtonStepTest, SymmetricSolutionMatchesAGeneralSolver) {
  std::mt19937 rng(14);
  for (int trial = 0; trial < 200; ++trial) {
    const Vector3d h = RandomUnit(rng);
    const Vector3d b = RandomUnit(rng);
    const Vector3d c = RandomUnit(rng);
    const Matrix3d A = 1.2 * Matrix3d::Identity() - h * h.transpose() - 0.2 * b * b.transpose();
    const Vector3d expected = A.fullPivLu().solve(c);
    EXPECT_LT((SolveSymmetric3(A, c) - expected).norm(), 1e-9 * (1.0 + expected.norm()));
  }
}

TEST(GaussNewtonStepTest, ParallelVectorsAndNoFieldGiveAFiniteStepThatRightsTheTilt) {
  const Vector3d up = Vector3d::UnitZ();
  const Vector3d up_measured = math::ExpSO3({0.02, 0.0, 0.0}) * up;
  for (const double rho : {0.0, 0.45}) {
    const Vector3d step = ReducedStep(up, up, up_measured, up_measured, rho);
    ASSERT_TRUE(step.allFinite());
    EXPECT_NEAR(2.0 * step.norm(), 0.02, 1e-4);
  }
}

TEST(GaussNewtonStepTest, FullStepWithoutFieldIsFinite) {
  const Vector3d up_measured = math::ExpSO3({0.02, 0.0, 0.0}) * Vector3d::UnitZ();
  const Vector4d step = FullStep(Quaterniond::Identity(), Vector3d::UnitZ(), FieldNed(60.0),
                                 up_measured, Vector3d::UnitX(), 0.0);
  EXPECT_TRUE(step.allFinite());
}

// Both forms take the same step: the full one has the component along q besides, which
// normalisation removes to first order in the error.
TEST(GaussNewtonStepTest, BothFormsAgreeToSecondOrder) {
  std::mt19937 rng(15);
  for (int trial = 0; trial < 100; ++trial) {
    const Quaterniond q_true = RandomQuaternion(rng);
    const Vector3d n = FieldNed(60.0);
    const Vector6 y0 = ComputedMeasurement(q_true, kDown, n);
    for (const double error_rad : {1e-2, 1e-3}) {
      const Quaterniond q = q_true * math::ExpSO3(error_rad * RandomUnit(rng));
      const Vector6 y = ComputedMeasurement(q, kDown, n);
      const Quaterniond by_full =
          Plus(q, FullStep(q, kDown, n, y0.head<3>(), y0.tail<3>(), 0.45)).normalized();
      const Vector3d dv = ReducedStep(y.head<3>(), y.tail<3>(), y0.head<3>(), y0.tail<3>(), 0.45);
      const Quaterniond by_reduced = (q * Quaterniond(1.0, dv.x(), dv.y(), dv.z())).normalized();
      EXPECT_LT(math::AngleBetween_rad(by_full, by_reduced), 2.0 * error_rad * error_rad);
      EXPECT_LT(math::AngleBetween_rad(by_full, q_true), 4.0 * error_rad * error_rad);
      EXPECT_LT(math::AngleBetween_rad(by_reduced, q_true), 4.0 * error_rad * error_rad);
    }
  }
}

// ENU, as the kernel has it.
Vector3d FieldEnu(double dip_deg) {
  const double dip = dip_deg * std::numbers::pi / 180.0;
  return {0.0, std::cos(dip), -std::sin(dip)};
}
kernel::Vector<double> Plain(const Vector3d& v) { return {v.x(), v.y(), v.z()}; }
Vector3d StepInEarth(const Quaterniond& q, const Vector3d& n, const Vector3d& h0,
                     const Vector3d& b0, double rho) {
  const kernel::Quaternion<double> p{q.w(), q.x(), q.y(), q.z()};
  const auto dv = kernel::MakeEarthStep(n.y(), n.z(), Plain(h0), Plain(b0), rho * rho, 1.0)
                      .At(kernel::EastInSensor(p), kernel::NorthInSensor(p), kernel::UpInSensor(p));
  return {dv.x, dv.y, dv.z};
}

TEST(GaussNewtonStepTest, TheStepInEarthAxesIsTheReducedStepTurned) {
  std::mt19937 rng(16);
  // 90°: a vertical field says nothing about heading. ρ = 0: no field.
  for (const double dip_deg : {-90.0, -60.0, 0.0, 45.0, 67.0, 85.0, 89.0, 90.0}) {
    const Vector3d n = FieldEnu(dip_deg);
    for (const double rho : {0.0, 0.2, 0.45, 1.0, 3.0}) {
      for (int trial = 0; trial < 50; ++trial) {
        const Quaterniond q = RandomQuaternion(rng);
        const Vector3d h0 = RandomUnit(rng);
        const Vector3d b0 = rho == 0.0 ? Vector3d::Zero().eval() : RandomUnit(rng);
        const Vector3d in_sensor =
            ReducedStep(q.conjugate() * Vector3d::UnitZ(), q.conjugate() * n, h0, b0, rho);
        const Vector3d in_earth = StepInEarth(q, n, h0, b0, rho);
        EXPECT_LT((q.conjugate() * in_earth - in_sensor).norm(), 1e-9 * (1.0 + in_sensor.norm()))
            << "dip " << dip_deg << " rho " << rho;
      }
    }
  }
}

TEST(GaussNewtonStepTest, AStepInEarthAxesIsTakenFromTheLeft) {
  std::mt19937 rng(17);
  for (int trial = 0; trial < 50; ++trial) {
    const Quaterniond q = RandomQuaternion(rng);
    const Vector3d v = RandomUnit(rng);
    const auto product =
        kernel::OnePlusTimes(Plain(v), kernel::Quaternion<double>{q.w(), q.x(), q.y(), q.z()});
    const Quaterniond expected = Quaterniond(1.0, v.x(), v.y(), v.z()) * q;
    EXPECT_LT(ComponentError({product.w, product.x, product.y, product.z}, expected), 1e-15 * 8.0);
  }
}

TEST(GaussNewtonStepTest, TheProductIsNormalisedByTheNormsOfItsFactors) {
  std::mt19937 rng(19);
  for (const double length : {0.0, 1e-6, 1e-4, 1e-3, 0.1, 3.0}) {
    for (const double stretch : {1.0 - 1e-9, 1.0, 1.0 + 1e-6, 1.01}) {
      const Quaterniond q = RandomQuaternion(rng);
      const Vector3d v = length * RandomUnit(rng);
      const auto p = kernel::NormalisedOnePlusTimes(
          Plain(v),
          kernel::Scaled(kernel::Quaternion<double>{q.w(), q.x(), q.y(), q.z()}, stretch));
      const Quaterniond expected = (Quaterniond(1.0, v.x(), v.y(), v.z()) * q).normalized();
      EXPECT_LT(ComponentError({p.w, p.x, p.y, p.z}, expected), 1e-15 * 8.0)
          << length << " " << stretch;
    }
  }
}

TEST(GaussNewtonStepTest, TheStepInEarthAxesAgreesWithTheFullStepToSecondOrder) {
  std::mt19937 rng(18);
  const Vector3d up = Vector3d::UnitZ();
  const Vector3d n = FieldEnu(60.0);
  for (const double rho : {0.2, 0.45, 1.0}) {
    for (int trial = 0; trial < 50; ++trial) {
      const Quaterniond q_true = RandomQuaternion(rng);
      const Vector6 y0 = ComputedMeasurement(q_true, up, n);
      for (const double error_rad : {1e-2, 1e-3}) {
        const Quaterniond q = q_true * math::ExpSO3(error_rad * RandomUnit(rng));
        const Quaterniond by_full =
            Plus(q, FullStep(q, up, n, y0.head<3>(), y0.tail<3>(), rho)).normalized();
        const Vector3d dv_E = StepInEarth(q, n, y0.head<3>(), y0.tail<3>(), rho);
        const Quaterniond by_earth =
            (Quaterniond(1.0, dv_E.x(), dv_E.y(), dv_E.z()) * q).normalized();
        EXPECT_LT(math::AngleBetween_rad(by_full, by_earth), 2.0 * error_rad * error_rad);
        EXPECT_LT(math::AngleBetween_rad(by_earth, q_true), 4.0 * error_rad * error_rad);
      }
    }
  }
}

// Table 1 of McGhee, Bachmann and Zyda's theory report, by the test rule of
// design/orientation.md section 7.
class TableOne {
 public:
  // RMS over the trials of the component error after `cycles` full steps.
  static double Rms(double max_noise, int cycles, double dip_deg, bool before_normalising,
                    int trials = 4000) {
    std::mt19937 rng(20010131);
    std::uniform_real_distribution<double> start_error(-0.1, 0.1);
    std::uniform_real_distribution<double> noise(-max_noise, max_noise);
    double sum = 0.0;
    for (int trial = 0; trial < trials; ++trial) {
      const Quaterniond q_true = RandomQuaternion(rng);
      const Vector3d n = FieldNed(dip_deg);
      Vector6 y0 = ComputedMeasurement(q_true, kDown, n);
      for (int i = 0; i < 6 && max_noise > 0.0; ++i) {
        y0[i] += noise(rng);
      }
      const Vector3d m0 = y0.head<3>().normalized();
      const Vector3d n0 = y0.tail<3>().normalized();
      Quaterniond q =
          Plus(q_true, {start_error(rng), start_error(rng), start_error(rng), start_error(rng)})
              .normalized();
      for (int cycle = 0; cycle < cycles; ++cycle) {
        q = Plus(q, FullStep(q, kDown, n, m0, n0, 1.0));
        if (cycle + 1 < cycles || !before_normalising) {
          q.normalize();
        }
      }
      const double error = ComponentError(q, q_true);
      sum += error * error;
    }
    return std::sqrt(sum / trials);
  }
};

struct TableRow {
  double max_noise;
  double two_cycles;
  double three_cycles;
};
class TableOneTest : public ::testing::TestWithParam<TableRow> {};

TEST_P(TableOneTest, ColumnsTwoAndThreeAgreeWithinTenPercent) {
  const TableRow row = GetParam();
  EXPECT_NEAR(TableOne::Rms(row.max_noise, 2, 60.0, false), row.two_cycles, 0.1 * row.two_cycles);
  EXPECT_NEAR(TableOne::Rms(row.max_noise, 3, 60.0, false), row.three_cycles,
              0.1 * row.three_cycles);
}

INSTANTIATE_TEST_SUITE_P(MaxNoise, TableOneTest,
                         ::testing::Values(TableRow{0.001, 8.30e-4, 8.12e-4},
                                           TableRow{0.01, 8.13e-3, 7.87e-3},
                                           TableRow{0.1, 8.63e-2, 8.30e-2}));

TEST(TableOneNoiselessTest, FirstColumnLiesBetweenTheTwoWaysToReadIt) {
  EXPECT_GT(TableOne::Rms(0.0, 1, 60.0, false), 4.4e-3);  // 4.9e-3 by the study, ±10 %
  EXPECT_LT(TableOne::Rms(0.0, 1, 60.0, false), 7.6e-3);
  EXPECT_NEAR(TableOne::Rms(0.0, 1, 60.0, true), 6.68e-3, 0.15 * 6.68e-3);
}

TEST(TableOneNoiselessTest, ConvergesQuadraticallyToRounding) {
  EXPECT_LT(TableOne::Rms(0.0, 2, 60.0, false), 2.0 * 3.17e-5);
  EXPECT_LT(TableOne::Rms(0.0, 3, 60.0, false), 9.3e-8);  // published in single precision
}

TEST(TableOneNoiselessTest, ErrorGrowsWithDipAsTheStudyFound) {
  const double at_60 = TableOne::Rms(0.01, 3, 60.0, false);
  EXPECT_NEAR(TableOne::Rms(0.01, 3, 0.0, false) / at_60, 0.55, 0.06);
  EXPECT_NEAR(TableOne::Rms(0.01, 3, 67.0, false) / at_60, 1.27, 0.13);
}

// "No failure in several hundred random starts after ten iterations": up to 1 % need more than ten,
// none fails in a hundred.
TEST(RandomStartTest, AlmostAllConvergeInTenCyclesAndAllInAHundred) {
  std::mt19937 rng(17);
  const Vector3d n = FieldNed(60.0);
  constexpr int kTrials = 5000;
  constexpr double kConverged_rad = 0.1 * std::numbers::pi / 180.0;
  for (const bool full : {true, false}) {
    int late_10 = 0;
    int late_20 = 0;
    int never = 0;
    for (int trial = 0; trial < kTrials; ++trial) {
      const Quaterniond q_true = RandomQuaternion(rng);
      const Vector6 y0 = ComputedMeasurement(q_true, kDown, n);
      Quaterniond q = RandomQuaternion(rng);
      for (int cycle = 1; cycle <= 100; ++cycle) {
        if (full) {
          q = Plus(q, FullStep(q, kDown, n, y0.head<3>(), y0.tail<3>(), 1.0)).normalized();
        } else {
          const Vector6 y = ComputedMeasurement(q, kDown, n);
          const Vector3d dv =
              ReducedStep(y.head<3>(), y.tail<3>(), y0.head<3>(), y0.tail<3>(), 1.0);
          q = (q * Quaterniond(1.0, dv.x(), dv.y(), dv.z())).normalized();
        }
        const bool converged = math::AngleBetween_rad(q, q_true) < kConverged_rad;
        late_10 += cycle == 10 && !converged ? 1 : 0;
        late_20 += cycle == 20 && !converged ? 1 : 0;
        never += cycle == 100 && !converged ? 1 : 0;
      }
    }
    EXPECT_LE(late_10, kTrials / 100) << (full ? "full" : "reduced");
    EXPECT_LE(late_20, kTrials / 1000) << (full ? "full" : "reduced");
    EXPECT_EQ(never, 0) << (full ? "full" : "reduced");
  }
}

}  // namespace
}  // namespace limbcast::filters
