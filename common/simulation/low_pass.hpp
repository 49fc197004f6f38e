#pragma once

#include <Eigen/Core>

namespace limbcast::simulation {

/// Second-order Butterworth low-pass for a vector: the filter in front of a sensor's converter. The
/// bilinear transform with the corner where it is meant to be (K = tan π f_c/f_s):
///   y = b₀(x + 2x₁ + x₂) − a₁y₁ − a₂y₂,  b₀ = K²/(1 + √2K + K²)
///
/// Oppenheim, Schafer, "Discrete-Time Signal Processing", 3rd ed., section 7.2.1.
///
/// Begins in the steady state of the first value. Thread-compatible.
class LowPass {
 public:
  /// 0 < corner_hz < rate_hz / 2.
  LowPass(double corner_hz, double rate_hz);

  [[nodiscard]] Eigen::Vector3d Filter(const Eigen::Vector3d& x);

 private:
  double b0_;
  double a1_;
  double a2_;
  bool begun_ = false;
  Eigen::Vector3d x1_ = Eigen::Vector3d::Zero();
  Eigen::Vector3d x2_ = Eigen::Vector3d::Zero();
  Eigen::Vector3d y1_ = Eigen::Vector3d::Zero();
  Eigen::Vector3d y2_ = Eigen::Vector3d::Zero();
};

}  // namespace limbcast::simulation
