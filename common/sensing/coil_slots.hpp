#pragma once

#include <cstdint>

#include "common/base/result.hpp"
#include "common/base/time.hpp"

namespace limbcast::sensing {

/// Several sources in one room (design/position.md section 11): only one may pulse at a time
/// wherever its field can be felt.
struct CoilSlotConfig {
  double pulse_s = 0.034;         ///< whole pulse, both polarities. Range: [0.001, 1]
  double clock_error_s = 0.0005;  ///< of any two clocks. Range: [0, 0.1]
  double tail_s = 0.001;          ///< of the field beyond the settling time. Range: [0, 0.1]
  /// The magnetometer samples when it likes: one of its periods is lost as well; 0 = in step.
  double free_running_hz = 0.0;
  double background_s = 0.017;       ///< in each burst nobody pulses for so long. Range: [0, 1]
  double burst_rate_hz = 1.0 / 0.6;  ///< that each user wants. Range: [0.01, 100]
  double moment_a_m2 = 0.713;        ///< Range: [0.001, 100]
  double harmless_tesla = 5e-9;  ///< field of another source that does no harm. Range: (0, 1e-6]
};
[[nodiscard]] Status Validate(const CoilSlotConfig& config);

/// What fits.
struct CoilSlotPlan {
  double guard_s = 0.0;           ///< 2 × clock error + tail (+ a sampling period)
  double slot_s = 0.0;            ///< pulse + guard
  double slots_per_s = 0.0;       ///< single pulses
  double burst_s = 0.0;           ///< three slots and a background slot
  double bursts_per_s = 0.0;      ///< all users within reuse distance together
  double users = 0.0;             ///< at the rate wanted, within reuse distance
  double reuse_distance_m = 0.0;  ///< from any source to any foreign sensor
  double duty = 0.0;              ///< of one source at the rate wanted
};
[[nodiscard]] CoilSlotPlan PlanCoilSlots(const CoilSlotConfig& config);

/// Field of another source, rms over directions and the three coils:
///   B = √2 μ₀ m / (4π D³)
[[nodiscard]] double ForeignField_tesla(double moment_a_m2, double distance_m);

/// When one source may pulse: frames begin at whole multiples of `frame` on the system clock, each
/// has `slots` slots of equal length, and one of them is its own.
struct CoilGrant {
  std::uint32_t slot = 0;   ///< from 0, below slots
  std::uint32_t slots = 1;  ///< at least 1
  Duration frame = std::chrono::milliseconds(200);
  bool operator==(const CoilGrant&) const = default;

  [[nodiscard]] Duration slot_length() const { return frame / slots; }
};

/// `at` lies in the grant's slot of some frame.
[[nodiscard]] bool IsInSlot(const CoilGrant& grant, Time at);
/// When the grant's slot begins next, at `at` or later.
[[nodiscard]] Time NextSlotBegin(const CoilGrant& grant, Time at);

}  // namespace limbcast::sensing
