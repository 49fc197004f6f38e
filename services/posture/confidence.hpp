#pragma once

#include <Eigen/Core>

#include "common/base/time.hpp"

namespace limbcast::posture {

/// What the confidence of a measured segment depends on.
struct ConfidenceInput {
  float sigma_rad = 0.0F;  ///< standard deviation of the orientation; 0 = the filter does not say
  bool aligned = true;     ///< the sensor's offset comes from a calibration
  /// How good that calibration was, 0 (no better than none) to 1; 1 when nothing is known of it.
  float alignment_quality = 1.0F;
  bool degraded = false;   ///< the filter bridges a gap or runs on part of the channels
  bool disturbed = false;  ///< the magnetic field is not the reference
  Duration age{};          ///< how much older than the skeleton the measurement is
};

/// From 0 (a guess) to 1: the product of
///   1 / (1 + (σ/σ₀)²), σ₀ = 0.2 rad · e^(−age/1 s) · ½(1 + quality), ½ if not aligned · 0.7 if
///   degraded · 0.8 if disturbed.
/// Ours, made to order segments by trust, not to state a probability. A σ or a quality that is not
/// finite: 0.
[[nodiscard]] float Confidence(const ConfidenceInput& input);

/// Standard deviation of a rotation error: the root of the trace. NaN stays NaN.
[[nodiscard]] float SigmaOf(const Eigen::Matrix3f& cov_rad2);

}  // namespace limbcast::posture
