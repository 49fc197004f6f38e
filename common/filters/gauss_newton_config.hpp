#pragma once

#include <span>

#include "common/base/result.hpp"
#include "common/filters/filter_settings.hpp"
#include "common/filters/precision.hpp"

namespace limbcast::filters {

/// Which of the published Gauss–Newton steps is taken; both lead to the same estimate.
enum class GaussNewtonForm { kReduced3x3 = 0, kFull4x4 = 1 };

/// How rates become rotations. The Euler step of the publications under-rotates by 3e-3 at 0.2 rad
/// per sample; kAuto takes it below 0.02 rad per sample and the exponential above. The exponential
/// is as fast: its series does not wait for the attitude, and its result needs no normalisation.
enum class RateIntegration { kAuto = 0, kEuler = 1, kExponential = 2 };

/// Tuning of GaussNewtonOrientation. The defaults suit a body-worn MARG sensor at 1–1000 Hz.
struct GaussNewtonConfig {
  GaussNewtonForm form = GaussNewtonForm::kReduced3x3;
  RateIntegration integration = RateIntegration::kExponential;

  /// Arithmetic of the core; single precision gives the same mean error and is faster in batches.
  Precision precision = Precision::kDouble;

  /// Feedback gain k; crossover frequency k/2π. Large values trust accelerometer and magnetometer,
  /// small values the gyro; published 0.1–4. 0 = automatic: 0.04 once the gyro null is known, 0.3
  /// before. Range: [0, 100].
  double k_per_s = 0.0;

  /// Emphasis of the magnetometer; 1 = the published equal weight, 0 = heading from the gyro alone.
  /// Range: [0, 10].
  double rho = 0.45;

  /// The gyro null is the mean over the first rest of this length; a sensor that is not at rest is
  /// not calibrated. 0 = off. Range: [0, 60].
  double null_time_s = 2.0;

  /// Gauss–Newton steps per sample. Range: [1, 20].
  int iterations = 1;

  /// Time over which the start is averaged. Range: [0, 10].
  double init_time_s = 0.5;

  bool operator==(const GaussNewtonConfig&) const = default;
};

/// The fields of GaussNewtonConfig by name, with their ranges.
[[nodiscard]] std::span<const SettingField<GaussNewtonConfig>> GaussNewtonFields();
[[nodiscard]] Status Validate(const GaussNewtonConfig& config);

}  // namespace limbcast::filters
