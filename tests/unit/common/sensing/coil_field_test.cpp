#include "common/sensing/coil_field.hpp"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <numbers>
#include <random>

namespace limbcast::sensing {
namespace {

constexpr double kRadius_m = 0.055;
constexpr double kAmpereTurns = 75.0;

// Law of Biot and Savart by the trapezoid rule, which converges exponentially on a circle.
Eigen::Vector3d BiotSavart(const Eigen::Vector3d& p) {
  constexpr int kPieces = 4000;
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (int i = 0; i < kPieces; ++i) {
    const double phi = 2.0 * std::numbers::pi * i / kPieces;
    const Eigen::Vector3d wire(kRadius_m * std::cos(phi), kRadius_m * std::sin(phi), 0.0);
    const Eigen::Vector3d along(-kRadius_m * std::sin(phi), kRadius_m * std::cos(phi), 0.0);
    const Eigen::Vector3d r = p - wire;
    sum += along.cross(r) / std::pow(r.norm(), 3);
  }
  return kMu0_t_m_a * kAmpereTurns / (4.0 * std::numbers::pi) * sum * 2.0 * std::numbers::pi /
         kPieces;
}

Eigen::Vector3d RandomPoint(std::mt19937& rng, double low_m, double high_m) {
  std::normal_distribution<double> normal;
  std::uniform_real_distribution<double> radius(low_m, high_m);
  const Eigen::Vector3d direction(normal(rng), normal(rng), normal(rng));
  return radius(rng) * direction.normalized();
}

TEST(CoilFieldTest, EqualsBiotSavart) {
  std::mt19937 rng(1);
  for (int trial = 0; trial < 200; ++trial) {
    const Eigen::Vector3d p = RandomPoint(rng, 0.07, 1.2);
    const Eigen::Vector3d expected = BiotSavart(p);
    EXPECT_LT((LoopField(kRadius_m, kAmpereTurns, p).field_tesla - expected).norm(),
              1e-12 * expected.norm())
        << p.transpose();
  }
}

TEST(CoilFieldTest, IsSmoothThroughTheAxis) {
  for (const double rho : {0.0, 1e-16, 1e-12, 1e-9, 1e-7, 1e-5, 1e-3}) {
    const Eigen::Vector3d p(0.6 * rho, -0.8 * rho, 0.2);
    const Eigen::Vector3d expected = BiotSavart(p);
    EXPECT_LT((LoopField(kRadius_m, kAmpereTurns, p).field_tesla - expected).norm(),
              1e-12 * expected.norm())
        << rho;
  }
  // On the axis: B_z = μ₀NI b²/(2 d³), B_ρ/ρ = 3 z B_z/(2 d²) (design/position.md section 6).
  const double d2 = kRadius_m * kRadius_m + 0.04;
  const FieldAndJacobian axis = LoopField(kRadius_m, kAmpereTurns, {0.0, 0.0, 0.2});
  const double B_z = kMu0_t_m_a * kAmpereTurns * kRadius_m * kRadius_m / (2.0 * std::pow(d2, 1.5));
  EXPECT_NEAR(axis.field_tesla.z() / B_z, 1.0, 1e-14);
  EXPECT_NEAR(axis.jacobian_tesla_m(0, 0) / (0.3 * B_z / d2), 1.0, 1e-13);
}

TEST(CoilFieldTest, ACoilOffTheCentreIsTheSameFieldElsewhere) {
  std::mt19937 rng(5);
  CoilSource apart;
  apart.centre_m.col(0) = Eigen::Vector3d(0.0, 0.12, 0.0);
  apart.centre_m.col(2) = Eigen::Vector3d(-0.03, 0.02, 0.01);
  EXPECT_TRUE(CoilSource{}.concentric());
  EXPECT_FALSE(apart.concentric());
  for (int trial = 0; trial < 30; ++trial) {
    const int coil = trial % 3;
    const Eigen::Vector3d p = RandomPoint(rng, 0.25, 1.0);
    const FieldAndJacobian here = CoilField(apart, coil, 1.5, p);
    const FieldAndJacobian there = CoilField({}, coil, 1.5, p - apart.centre_m.col(coil));
    EXPECT_EQ(here.field_tesla, there.field_tesla);
    EXPECT_EQ(here.jacobian_tesla_m, there.jacobian_tesla_m);
    const Eigen::Vector3d mirrored = CoilField(apart, coil, 1.5, -p).field_tesla;
    EXPECT_EQ((mirrored - here.field_tesla).norm() < 1e-12 * here.field_tesla.norm(), coil == 1)
        << "only what is in the centre is the same on the other side";
  }
}

TEST(CoilFieldTest, CoilsTogetherAreTheirSum) {
  const Eigen::Vector3d p(0.2, -0.1, 0.3);
  const Eigen::Vector3d currents_a(0.4, -0.7, 0.0);
  const FieldAndJacobian all = CoilsField({}, currents_a, p);
  const FieldAndJacobian x = CoilField({}, 0, 0.4, p);
  const FieldAndJacobian y = CoilField({}, 1, -0.7, p);
  EXPECT_LT((all.field_tesla - x.field_tesla - y.field_tesla).norm(), 1e-20);
  EXPECT_LT((all.jacobian_tesla_m - x.jacobian_tesla_m - y.jacobian_tesla_m).norm(), 1e-18);
}

TEST(CoilFieldTest, JacobianIsSymmetricAndTraceless) {
  std::mt19937 rng(2);
  for (int trial = 0; trial < 100; ++trial) {
    const Eigen::Matrix3d J =
        CoilField({}, trial % 3, 1.5, RandomPoint(rng, 0.08, 1.0)).jacobian_tesla_m;
    EXPECT_LT((J - J.transpose()).norm(), 1e-14 * J.norm());
    EXPECT_LT(std::abs(J.trace()), 1e-13 * J.norm());
  }
}

TEST(CoilFieldTest, JacobianMatchesDifferences) {
  std::mt19937 rng(3);
  const double h = 1e-5;
  for (int trial = 0; trial < 200; ++trial) {
    Eigen::Vector3d p = RandomPoint(rng, 0.08, 1.0);
    if (trial % 10 == 0) {
      p.head<2>() *= 1e-9;  // on the axis of coil 2
    }
    const int coil = trial % 3;
    const FieldAndJacobian at = CoilField({}, coil, -1.5, p);
    Eigen::Matrix3d expected;
    for (int i = 0; i < 3; ++i) {
      const Eigen::Vector3d step = h * Eigen::Vector3d::Unit(i);
      expected.col(i) = (CoilField({}, coil, -1.5, p + step).field_tesla -
                         CoilField({}, coil, -1.5, p - step).field_tesla) /
                        (2.0 * h);
    }
    EXPECT_LT((at.jacobian_tesla_m - expected).norm(), 3e-6 * expected.norm()) << p.transpose();
  }
}

TEST(CoilFieldTest, IsTheSameOnTheOppositeSide) {
  std::mt19937 rng(4);
  for (int trial = 0; trial < 20; ++trial) {
    const Eigen::Vector3d p = RandomPoint(rng, 0.1, 1.0);
    EXPECT_LT((CoilFieldsPerAmpere({}, p) - CoilFieldsPerAmpere({}, -p)).norm(),
              1e-14 * CoilFieldsPerAmpere({}, p).norm());
  }
}

TEST(CoilFieldTest, BecomesADipoleFarAway) {
  const CoilSource source;
  const Eigen::Vector3d p(3.0, -4.0, 5.0);
  for (int coil = 0; coil < 3; ++coil) {
    const Eigen::Vector3d dipole =
        DipoleField_tesla(source.MomentPerAmpere(coil) * Eigen::Vector3d::Unit(coil), p);
    EXPECT_LT((CoilField(source, coil, 1.0, p).field_tesla - dipole).norm(), 2e-4 * dipole.norm());
  }
  EXPECT_NEAR(1.5 * source.MomentPerAmpere(0), 0.713, 5e-4);
}

TEST(CoilFieldTest, ADipoleIsFivePercentOffAtFiveAndAHalfRadii) {
  const CoilSource source;
  const Eigen::Vector3d p(0.0, 0.0, 5.5 * source.radius_m);
  const double ratio = DipoleField_tesla({0.0, 0.0, source.MomentPerAmpere(2)}, p).z() /
                       CoilField(source, 2, 1.0, p).field_tesla.z();
  EXPECT_NEAR(ratio, 1.05, 1e-3);
}

TEST(CoilFieldTest, FollowsCurrentTurnsAndCalibration) {
  CoilSource source;
  const Eigen::Vector3d p(0.2, 0.1, -0.3);
  const Eigen::Vector3d plain = CoilField(source, 1, 1.0, p).field_tesla;
  source.moment_factor = {1.0, 1.02, 1.0};
  EXPECT_LT((CoilField(source, 1, -2.0, p).field_tesla + 2.04 * plain).norm(),
            1e-14 * plain.norm());
}

}  // namespace
}  // namespace limbcast::sensing
