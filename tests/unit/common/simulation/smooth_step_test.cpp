#include "common/simulation/smooth_step.hpp"

#include <gtest/gtest.h>

namespace limbcast::simulation {
namespace {

using Function = Jet (*)(const Jet&);

void ExpectDerivatives(Function f, double x) {
  constexpr double kStep = 1e-4;
  const Jet at = f(Jet::Variable(x));
  const double before = f(Jet::Variable(x - kStep)).value;
  const double after = f(Jet::Variable(x + kStep)).value;
  EXPECT_NEAR(at.rate, (after - before) / (2.0 * kStep), 1e-5) << "at " << x;
  EXPECT_NEAR(at.accel, (after - 2.0 * at.value + before) / (kStep * kStep), 1e-4) << "at " << x;
}

Jet Step(const Jet& x) { return SmoothStep(x); }

TEST(SmoothStepTest, DerivativesAreThoseOfTheValue) {
  for (const Function f : {&Step, &QuickStep, &SmoothStepIntegral, &Bump, &EarlyBump}) {
    for (double x = -0.15; x < 1.2; x += 0.1) {
      ExpectDerivatives(f, x);
    }
  }
}

TEST(SmoothStepTest, BeginsAndEndsWithoutSpeedOrAcceleration) {
  constexpr double kBeside = 1e-5;
  for (const Function f : {&Step, &QuickStep}) {
    EXPECT_EQ(f(Jet::Variable(-1.0)).value, 0.0);
    EXPECT_EQ(f(Jet::Variable(2.0)).value, 1.0);
    EXPECT_NEAR(f(Jet::Variable(0.5)).value, 0.5, 1e-15);
    for (const double x : {kBeside, 1.0 - kBeside}) {
      EXPECT_NEAR(f(Jet::Variable(x)).rate, 0.0, 1e-6);
      EXPECT_NEAR(f(Jet::Variable(x)).accel, 0.0, 1e-3);
    }
  }
  EXPECT_NEAR(SmoothStepIntegral(Jet::Variable(1.0 - kBeside)).value, 0.5 - kBeside, 1e-9);
}

TEST(SmoothStepTest, BumpsReachOneAndWindowsHoldIt) {
  EXPECT_NEAR(Bump(Jet{0.5}).value, 1.0, 1e-15);
  EXPECT_NEAR(EarlyBump(Jet{0.375}).value, 1.0, 1e-14);
  EXPECT_EQ(Bump(Jet{1.0}).value, 0.0);
  EXPECT_EQ(Window(Jet{3.0}, 1.0, 5.0, 1.0).value, 1.0);
  EXPECT_EQ(Window(Jet{0.9}, 1.0, 5.0, 1.0).value, 0.0);
  EXPECT_EQ(Window(Jet{5.1}, 1.0, 5.0, 1.0).value, 0.0);
}

}  // namespace
}  // namespace limbcast::simulation
