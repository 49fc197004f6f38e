#pragma once

#include <chrono>
#include <cstdint>

namespace limbcast {

using Duration = std::chrono::nanoseconds;

/// Nanoseconds since the Unix epoch (UTC without leap seconds), the one time scale of the project.
/// It is a tag and has no now(): clocks are passed in (common/base/clock.hpp).
struct UnixEpoch {
  using rep = std::int64_t;
  using period = std::nano;
  using duration = Duration;
  using time_point = std::chrono::time_point<UnixEpoch>;
  static constexpr bool is_steady = false;
};

/// An instant, int64 nanoseconds since the Unix epoch (range: years 1678 to 2262).
using Time = UnixEpoch::time_point;

[[nodiscard]] constexpr Time TimeFromNanoseconds(std::int64_t ns) { return Time{Duration{ns}}; }
[[nodiscard]] constexpr std::int64_t ToNanoseconds(Time time) {
  return time.time_since_epoch().count();
}

[[nodiscard]] constexpr double ToSeconds(Duration duration) {
  return std::chrono::duration<double>(duration).count();
}
/// Nearest nanosecond; `seconds` finite and within ±9.2e9.
[[nodiscard]] constexpr Duration DurationFromSeconds(double seconds) {
  return Duration{static_cast<std::int64_t>(seconds * 1e9 + (seconds < 0.0 ? -0.5 : 0.5))};
}

}  // namespace limbcast
