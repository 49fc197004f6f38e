#include "common/sensing/elliptic_integrals.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace limbcast::sensing {
namespace {

TEST(EllipticIntegralsTest, EqualTheStandardLibrary) {
  for (const double m : {0.0, 1e-12, 1e-6, 0.01, 0.3, 0.7, 0.95, 0.9999, 1.0 - 1e-9}) {
    const EllipticIntegrals e = EllipticIntegralsOf(m);
    const double k = std::sqrt(m);  // rounded, which counts 1/(1 − m) times near 1
    const double tolerance = 1e-13 + 1e-16 / (1.0 - m);
    EXPECT_NEAR(e.K / std::comp_ellint_1(k), 1.0, tolerance) << m;
    EXPECT_NEAR(e.E(m) / std::comp_ellint_2(k), 1.0, 3.0 * tolerance) << m;
  }
}

TEST(EllipticIntegralsTest, BeginAsTheirSeries) {
  // E/K = 1 − m/2 − m²/16 − m³/32 − 41 m⁴/2048 − ...
  const EllipticIntegrals e = EllipticIntegralsOf(1e-4);
  EXPECT_NEAR(e.t, 1.0 / 16.0 + 1e-4 / 32.0 + 1e-8 * 41.0 / 2048.0, 1e-13);
  EXPECT_NEAR(e.t_by_m, 1.0 / 32.0 + 1e-4 * 41.0 / 1024.0, 1e-9);
  EXPECT_NEAR(EllipticIntegralsOf(0.0).K_by_m, std::numbers::pi / 8.0, 1e-15);
}

TEST(EllipticIntegralsTest, DerivativesMatchDifferences) {
  for (const double m : {0.01, 0.2, 0.6, 0.9}) {
    const double h = 1e-6;
    const EllipticIntegrals e = EllipticIntegralsOf(m);
    const EllipticIntegrals up = EllipticIntegralsOf(m + h);
    const EllipticIntegrals down = EllipticIntegralsOf(m - h);
    EXPECT_NEAR(e.K_by_m, (up.K - down.K) / (2.0 * h), 1e-7) << m;
    EXPECT_NEAR(e.t_by_m, (up.t - down.t) / (2.0 * h), 1e-7) << m;
  }
}

}  // namespace
}  // namespace limbcast::sensing
