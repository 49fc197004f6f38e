#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "common/filters/position/coil_inertial_config.hpp"
#include "common/filters/position/coil_inertial_filter.hpp"
#include "common/simulation/random.hpp"
#include "tools/limbcast/evaluate/coil_experiments.hpp"
#include "tools/limbcast/evaluate/coil_score.hpp"

namespace limbcast::tool {

/// Simulated experiments count from here on: 2 s after the motion began.
inline constexpr double kCoilScoredFrom_s = 5.0;

/// What is compared.
enum class CoilMethod : std::uint8_t { kMagneticOnly, kLoose, kForward, kFixedLag, kSmoothed };
inline constexpr std::size_t kCoilMethodCount = 5;
inline constexpr std::array<const char*, kCoilMethodCount> kCoilMethodNames = {
    "magnetic_only", "loose", "forward", "lag_0.6_s", "smoothed"};

/// The magnetometer and its pulses.
enum class CoilNoise : std::uint8_t {
  kThesis,  ///< 50 nT a sample, unipolar pulses of 60 ms, 3 in 600 ms
  kModern,  ///< 15 nT, bipolar 17 + 17 ms, 3 in 600 ms
};

inline constexpr std::array kCoilNoises = {CoilNoise::kThesis, CoilNoise::kModern};

/// An experiment, as an index, at one noise.
struct CoilCase {
  CoilNoise noise = CoilNoise::kThesis;
  std::size_t experiment = 0;
};
/// The experiments whose name has `only` in it, at each noise.
[[nodiscard]] std::vector<CoilCase> CoilCasesOf(const std::vector<CoilExperiment>& experiments,
                                                const std::string& only);

/// How a filter kept to its track over the scored time.
struct CoilTracking {
  double tracked = 0.0;  ///< part of it in which the filter was valid
  int losses = 0;        ///< of the whole trial
  double nees = 0.0;     ///< mean |error|² / trace of the covariance; 1 when it is honest
};

struct CoilResult {
  std::string experiment;
  CoilNoise noise = CoilNoise::kThesis;
  std::array<CoilFigure, kCoilMethodCount> figures;
  int repetitions = 1;  ///< of which the figures are means (coil_repetitions.hpp)
  std::array<CoilFigure, kCoilMethodCount> deviations{};  ///< between them; without counts
  double mean_range_m = 0.0;
  CoilTracking forward;  ///< of the tightly coupled filter, which lag and smoothing stand on
  CoilTracking loose;
};

/// Frames with their truth, and the filter that is to follow them.
struct CoilTrial {
  std::string name;
  CoilNoise noise = CoilNoise::kThesis;
  double rate_hz = 120.0;
  std::vector<simulation::CoilTick> ticks;  ///< at least one, evenly spaced
  std::vector<std::uint8_t> scored;         ///< 1: this tick counts
  filters::CoilInertialConfig config;
};

/// Noise of one magnetometer sample, and pulses.
[[nodiscard]] double SigmaOf_tesla(CoilNoise noise);
[[nodiscard]] simulation::CoilPulseConfig PulsesOf(CoilNoise noise);
/// A room: the field changes by about 0.3 µT in a metre, each component by each coordinate.
[[nodiscard]] Eigen::Matrix3d DrawGradient_tesla_m(simulation::Random& random);
[[nodiscard]] Eigen::Matrix3d DrawGradient_tesla_m(std::uint64_t seed);

/// RMS errors of the tightly coupled filter as it goes.
struct CoilLiveFigures {
  CoilFigure forward;
  CoilFigure lagged;  ///< by 0.6 s
  CoilTracking tracking;
  double mean_range_m = 0.0;
};
/// Lets the filter follow the trial.
///
/// @param on_update  called after each of its updates, when not empty.
[[nodiscard]] CoilLiveFigures EvaluateLive(
    const CoilTrial& trial,
    const std::function<void(const filters::CoilInertialFilter&, Time)>& on_update = {});

/// The same, and the whole recording smoothed.
struct CoilFollowed {
  CoilLiveFigures live;
  CoilFigure smoothed;
};
[[nodiscard]] CoilFollowed FollowTrial(const CoilTrial& trial);

/// Lets all methods run. Magnetic only: least squares on each three pulses, columns turned by gyro,
/// no inertial displacement, compared in the middle of the second pulse. Loose: the same poses,
/// with inertial displacement, as measurements of the filter, forward.
[[nodiscard]] CoilResult EvaluateTrial(const CoilTrial& trial);

/// The experiment with the sensors of `noise` in a room with a gradient, and the filter for it.
[[nodiscard]] simulation::CoilStreamConfig MakeCoilStream(const CoilExperiment& experiment,
                                                          CoilNoise noise, std::uint64_t seed);
[[nodiscard]] filters::CoilInertialConfig MakeCoilFilter(const CoilExperiment& experiment,
                                                         CoilNoise noise);

/// Simulates the experiment, which counts from 5 s on (2 s after the motion began).
[[nodiscard]] CoilTrial MakeCoilTrial(const CoilExperiment& experiment, CoilNoise noise,
                                      std::uint64_t seed);
/// The same with another source or filter than these.
[[nodiscard]] CoilTrial MakeCoilTrial(const CoilExperiment& experiment, CoilNoise noise,
                                      const simulation::CoilStreamConfig& stream,
                                      const filters::CoilInertialConfig& filter,
                                      std::uint64_t seed);
[[nodiscard]] CoilResult EvaluateCoil(const CoilExperiment& experiment, CoilNoise noise,
                                      std::uint64_t seed);

}  // namespace limbcast::tool
