#pragma once

#include <array>
#include <cstdint>
#include <string>

#include "tools/limbcast/evaluate/coil_experiments.hpp"

namespace limbcast::tool {

/// What is compared.
enum class CoilMethod : std::uint8_t { kMagneticOnly, kForward, kFixedLag, kSmoothed };
inline constexpr std::size_t kCoilMethodCount = 4;
inline constexpr std::array<const char*, kCoilMethodCount> kCoilMethodNames = {
    "magnetic_only", "forward", "lag_0.6_s", "smoothed"};

/// RMS errors of one method over one trial.
struct CoilFigure {
  int count = 0;
  double position_m = 0.0;  ///< 3-D, emitter axes
  double distance_m = 0.0;  ///< of |p|
  double orientation_rad = 0.0;
};

/// The magnetometer and its pulses.
enum class CoilNoise : std::uint8_t {
  kThesis,  ///< 50 nT a sample, unipolar pulses of 60 ms, 3 in 600 ms
  kModern,  ///< 15 nT, bipolar 17 + 17 ms, 3 in 600 ms
};

struct CoilResult {
  std::string experiment;
  CoilNoise noise = CoilNoise::kThesis;
  std::array<CoilFigure, kCoilMethodCount> figures;
  double mean_range_m = 0.0;
  double tracked = 0.0;  ///< part of the scored time in which the filter was valid
  int losses = 0;
  double nees = 0.0;  ///< mean |error|² / trace of the covariance, forward; 1 when it is honest
};

/// Simulates the experiment and lets all methods run. Scored from 5 s on (2 s after the motion
/// began). Magnetic only: least squares on each three pulses, columns turned by gyro, no inertial
/// displacement, compared in the middle of the second pulse.
[[nodiscard]] CoilResult EvaluateCoil(const CoilExperiment& experiment, CoilNoise noise,
                                      std::uint64_t seed);

}  // namespace limbcast::tool
