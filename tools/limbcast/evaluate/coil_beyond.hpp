#pragma once

#include <array>
#include <cstdint>
#include <nlohmann/json_fwd.hpp>
#include <span>
#include <string>

#include "tools/limbcast/evaluate/coil_experiments.hpp"
#include "tools/limbcast/evaluate/coil_trial.hpp"

namespace limbcast::tool {

/// Sources that the thesis did not have.
enum class CoilVariant : std::uint8_t {
  kPulses,      ///< as published, 120 Hz
  kApart,       ///< the same with the coils 12 cm to both sides and one in the middle
  kTones,       ///< three tones at once, as much heat in the coils as with the pulses, 120 Hz
  kPulsesFast,  ///< a magnetometer of 400 Hz, as noisy in each sample
  kTonesFast,
};
inline constexpr std::size_t kCoilVariantCount = 5;
inline constexpr std::array<const char*, kCoilVariantCount> kCoilVariantNames = {
    "pulses", "coils apart", "tones", "pulses 400 Hz", "tones 400 Hz"};

struct CoilBeyondResult {
  std::string experiment;
  CoilNoise noise = CoilNoise::kThesis;
  std::array<CoilLiveFigures, kCoilVariantCount> variants;
};

/// Simulates the same motion with each source and scores from 5 s on. The filter of coils apart is
/// not told on which side the sensor is.
[[nodiscard]] CoilBeyondResult EvaluateBeyond(const CoilExperiment& experiment, CoilNoise noise,
                                              std::uint64_t seed);

[[nodiscard]] std::string BeyondTable(std::span<const CoilBeyondResult> results);
[[nodiscard]] nlohmann::json BeyondJson(std::span<const CoilBeyondResult> results,
                                        std::uint64_t seed);

}  // namespace limbcast::tool
