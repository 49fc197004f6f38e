#include "common/sensing/coil_tones.hpp"

#include <algorithm>
#include <limits>
#include <numbers>

#include "common/base/range.hpp"

namespace limbcast::sensing {

Status Validate(const CoilTones& tones, double rate_hz) {
  constexpr double kInf = std::numeric_limits<double>::infinity();
  constexpr double kLeastCurrent_a = 1e-6;
  constexpr double kRounding_hz = 1e-9;  // tones exactly as far apart as they have to be
  const double highest_hz = CoilTones::kHighestOfRate * rate_hz;
  Eigen::Vector3d sorted_hz = tones.frequency_hz;
  std::sort(sorted_hz.begin(), sorted_hz.end());
  const double apart_hz =
      std::min(sorted_hz[1] - sorted_hz[0], sorted_hz[2] - sorted_hz[1]) + kRounding_hz;
  return CheckRanges(
      "tones.", {{"window_s", tones.window_s, 0.05, 2.0},
                 {"amplitude_a", tones.amplitude_a, kLeastCurrent_a, 20.0},
                 {"frequency_hz[0]", tones.frequency_hz[0], CoilTones::kLowestTone_hz, highest_hz},
                 {"frequency_hz[1]", tones.frequency_hz[1], CoilTones::kLowestTone_hz, highest_hz},
                 {"frequency_hz[2]", tones.frequency_hz[2], CoilTones::kLowestTone_hz, highest_hz},
                 {"frequency_hz apart by", apart_hz, 2.0 / tones.window_s, kInf}});
}

Eigen::Vector3d ToneCurrents_a(const CoilTones& tones, double t_s) {
  return tones.amplitude_a * (2.0 * std::numbers::pi * t_s * tones.frequency_hz).array().sin();
}

}  // namespace limbcast::sensing
