#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "common/body/motion_record.hpp"

namespace limbcast::body {

/// The rhythm of a stretch of walking.
struct Gait {
  double stride_s = 0.0;     ///< both feet once
  double periodicity = 0.0;  ///< autocorrelation one stride on, in [−1, 1]; 1 = exactly periodic
  /// rms of what was looked at over the least that counts as walking, of the weakest 2 s
  double intensity = 0.0;
};

/// Finds the stride by the autocorrelation of the legs' angular speed, which repeats once a stride;
/// without sensors on the legs by the vertical acceleration of the trunk, which repeats with every
/// step.
///
/// Moe-Nilssen, Helbostad, "Estimation of gait cycle characteristics by trunk accelerometry",
/// J. Biomech. 37 (2004) 121–126: unbiased autocorrelation, first dominant period.
///
/// Nothing when the stretch is shorter than three strides, when nobody moves enough, or when no
/// period in [0.7, 2.2] s reaches kMinPeriodicity.
[[nodiscard]] std::optional<Gait> FindGait(const std::vector<SmoothMotion>& motions,
                                           double rate_hz);
inline constexpr double kMinPeriodicity = 0.3;

/// The longest stretch in which somebody moves as one who walks; people stand before and after.
struct Stretch {
  std::size_t begin = 0;
  std::size_t end = 0;  ///< one past the last
};
[[nodiscard]] Stretch LongestActivity(const std::vector<SmoothMotion>& motions, double rate_hz);

}  // namespace limbcast::body
