#pragma once

#include <array>
#include <cstdint>
#include <nlohmann/json_fwd.hpp>
#include <span>
#include <string>

#include "tools/limbcast/evaluate/coil_trial.hpp"

namespace limbcast::tool {

/// The filter with more and more of its states.
enum class CoilStates : std::uint8_t {
  kSpecification,  ///< the 27 of design/position.md section 10
  kCalibration,    ///< and M_a, M_g and t_g of the sensor
  kGradient,       ///< and the gradient of the background
  kCompass,        ///< and the magnetometer of the source's unit: as shipped
};
inline constexpr std::size_t kCoilStatesCount = 4;
inline constexpr std::array<const char*, kCoilStatesCount> kCoilStatesNames = {
    "specification", "+ calibration", "+ gradient", "+ source's compass"};

struct CoilStatesResult {
  std::string experiment;
  CoilNoise noise = CoilNoise::kThesis;
  int repetitions = 0;
  /// Means over the repetitions, 3-D position.
  struct Figures {
    double forward_m = 0.0;
    double smoothed_m = 0.0;
    double forward_rad = 0.0;
    double nees = 0.0;
  };
  std::array<Figures, kCoilStatesCount> figures;
};

/// Lets each filter follow the same simulated experiment, drawn anew in each repetition.
///
/// @param experiment  index in MakeCoilExperiments().
[[nodiscard]] CoilStatesResult EvaluateCoilStates(std::size_t experiment, CoilNoise noise,
                                                  std::uint64_t seed, int repetitions);

[[nodiscard]] std::string CoilStatesTable(std::span<const CoilStatesResult> results);
[[nodiscard]] nlohmann::json CoilStatesJson(std::span<const CoilStatesResult> results,
                                            std::uint64_t seed);

}  // namespace limbcast::tool
