#include "common/simulation/low_pass.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace limbcast::simulation {
namespace {

constexpr double kRate_hz = 400.0;

// Amplitude of what is left of a sine after the filter has settled.
double Gain(double corner_hz, double frequency_hz) {
  LowPass filter(corner_hz, kRate_hz);
  double largest = 0.0;
  for (int i = 0; i < 4000; ++i) {
    const double x = std::sin(2.0 * std::numbers::pi * frequency_hz * i / kRate_hz);
    const double y = filter.Filter({x, 0.0, 0.0}).x();
    largest = i > 2000 ? std::max(largest, std::abs(y)) : largest;
  }
  return largest;
}

TEST(LowPassTest, BeginsInTheSteadyStateAndPassesConstants) {
  LowPass filter(10.0, kRate_hz);
  const Eigen::Vector3d x(1.0, -2.0, 9.81);
  for (int i = 0; i < 100; ++i) {
    EXPECT_LT((filter.Filter(x) - x).norm(), 1e-12);
  }
}

// |H|² = 1/(1 + (tan πf/f_s / tan πf_c/f_s)⁴), Butterworth of second order after the bilinear
// transform.
TEST(LowPassTest, HasTheGainOfASecondOrderButterworth) {
  for (const double frequency_hz : {1.0, 5.0, 10.0, 20.0, 50.0}) {
    const double ratio = std::tan(std::numbers::pi * frequency_hz / kRate_hz) /
                         std::tan(std::numbers::pi * 10.0 / kRate_hz);
    EXPECT_NEAR(Gain(10.0, frequency_hz), 1.0 / std::sqrt(1.0 + std::pow(ratio, 4)), 2e-3)
        << frequency_hz;
  }
}

// Group delay of slow signals: √2/(2πf_c).
TEST(LowPassTest, DelaysARampByTheGroupDelay) {
  LowPass filter(10.0, kRate_hz);
  double y = 0.0;
  int i = 0;
  for (; i < 1000; ++i) {
    y = filter.Filter({0.0, 0.0, i / kRate_hz}).z();
  }
  EXPECT_NEAR((i - 1) / kRate_hz - y, std::numbers::sqrt2 / (2.0 * std::numbers::pi * 10.0), 1e-4);
}

}  // namespace
}  // namespace limbcast::simulation
