#pragma once

#include "common/base/result.hpp"

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

}  // namespace limbcast::sensing
