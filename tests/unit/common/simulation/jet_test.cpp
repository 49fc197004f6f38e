#include "common/simulation/jet.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>

namespace limbcast::simulation {
namespace {

// Compares the derivatives that jets carry with central differences of the values.
void ExpectDerivatives(const std::function<Jet(const Jet&)>& f, double t) {
  constexpr double kStep = 1e-4;
  const Jet at = f(Jet::Variable(t));
  const double before = f(Jet::Variable(t - kStep)).value;
  const double after = f(Jet::Variable(t + kStep)).value;
  EXPECT_NEAR(at.rate, (after - before) / (2.0 * kStep), 1e-6) << "at " << t;
  EXPECT_NEAR(at.accel, (after - 2.0 * at.value + before) / (kStep * kStep), 1e-5) << "at " << t;
}

TEST(JetTest, EveryFunctionCarriesItsDerivatives) {
  for (const double t : {-0.7, 0.1, 0.6}) {
    const auto inner = [](const Jet& x) { return 0.3 * x * x + 0.5 * x + 0.2; };
    ExpectDerivatives([&](const Jet& x) { return Sin(inner(x)); }, t);
    ExpectDerivatives([&](const Jet& x) { return Cos(inner(x)); }, t);
    ExpectDerivatives([&](const Jet& x) { return Sqrt(2.0 + inner(x)); }, t);
    ExpectDerivatives([&](const Jet& x) { return Inverse(2.0 + inner(x)); }, t);
    ExpectDerivatives([&](const Jet& x) { return inner(x) / (x * x + 1.0); }, t);
    ExpectDerivatives([&](const Jet& x) { return Acos(0.8 * inner(x)); }, t);
    ExpectDerivatives([&](const Jet& x) { return Atan2(inner(x), x * x + 0.3); }, t);
    ExpectDerivatives([&](const Jet& x) { return -inner(x) * inner(x) - x; }, t);
  }
}

TEST(JetTest, AngleHasNoJumpInItsDerivativesAtPi) {
  const auto turning = [](const Jet& t) { return Atan2(Sin(3.0 * t), Cos(3.0 * t)); };
  for (const double t : {1.0471, 1.0473}) {  // 3t just below and above π
    EXPECT_NEAR(turning(Jet::Variable(t)).rate, 3.0, 1e-9);
    EXPECT_NEAR(turning(Jet::Variable(t)).accel, 0.0, 1e-9);
  }
}

TEST(JetTest, VectorsMultiplyAsVectorsDo) {
  const Jet t = Jet::Variable(0.4);
  const Jet3 a = {t, t * t, Sin(t)};
  const Jet3 b = {Cos(t), 1.0 + t, t * t * t};
  EXPECT_NEAR(Dot(a, Cross(a, b)).value, 0.0, 1e-15);
  EXPECT_NEAR(Dot(a, Cross(a, b)).rate, 0.0, 1e-14);
  EXPECT_NEAR(Dot(a, Cross(a, b)).accel, 0.0, 1e-14);
  const Jet length2 = Dot(Normalized(a), Normalized(a));
  EXPECT_NEAR(length2.value, 1.0, 1e-15);
  EXPECT_NEAR(length2.rate, 0.0, 1e-14);
  EXPECT_NEAR(length2.accel, 0.0, 1e-13);
}

}  // namespace
}  // namespace limbcast::simulation
