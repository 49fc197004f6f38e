#include "common/simulation/low_pass.hpp"

#include <cmath>
#include <numbers>

#include "common/base/expects.hpp"

namespace limbcast::simulation {

LowPass::LowPass(double corner_hz, double rate_hz) {
  Expects(corner_hz > 0.0 && corner_hz < 0.5 * rate_hz, "a corner below half the rate");
  const double k = std::tan(std::numbers::pi * corner_hz / rate_hz);
  const double norm = 1.0 / (1.0 + std::numbers::sqrt2 * k + k * k);
  b0_ = k * k * norm;
  a1_ = 2.0 * (k * k - 1.0) * norm;
  a2_ = (1.0 - std::numbers::sqrt2 * k + k * k) * norm;
}

Eigen::Vector3d LowPass::Filter(const Eigen::Vector3d& x) {
  if (!begun_) {
    x1_ = x2_ = y1_ = y2_ = x;
    begun_ = true;
  }
  Eigen::Vector3d y = b0_ * (x + 2.0 * x1_ + x2_) - a1_ * y1_ - a2_ * y2_;
  x2_ = x1_;
  x1_ = x;
  y2_ = y1_;
  y1_ = y;
  return y;
}

}  // namespace limbcast::simulation
