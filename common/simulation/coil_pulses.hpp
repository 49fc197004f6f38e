#pragma once

#include "common/base/result.hpp"
#include "common/sensing/coil_frame.hpp"

namespace limbcast::simulation {

/// Pulses of three coils in turn, equally spaced over the cycle (design/position.md section 7).
struct CoilPulseConfig {
  double cycle_s = 0.6;             ///< X, Y and Z once. Range: [0.05, 60]
  double plateau_s = 0.06;          ///< of one polarity. Range: [0.01, 1]
  bool bipolar = false;             ///< then the other polarity for as long
  double current_a = 1.5;           ///< Range: (0, 20]
  double settling_s = 0.0085;       ///< after each edge samples are useless. Range: [0, 0.05]
  double time_constant_s = 0.0012;  ///< L/R of the current. Range: [0, 0.01]
  double begin_s = 1.0;             ///< no pulse before
  double clock_error_s = 0.0;       ///< the source pulses so much later than it says
};
[[nodiscard]] Status Validate(const CoilPulseConfig& config);

/// How long a coil is on, both polarities.
[[nodiscard]] double PulseLength_s(const CoilPulseConfig& config);

/// The thesis' pulses (3 × 60 ms in 600 ms) and the ones of section 7 (17 ms + then 17 ms −).
[[nodiscard]] CoilPulseConfig ThesisPulses();
[[nodiscard]] CoilPulseConfig BipolarPulses();

/// One pulse, long past or not yet over.
struct CoilPulse {
  int coil = -1;  ///< −1: none yet
  double begin_s = 0.0;
  double current_a = 0.0;  ///< of the plateau
};
/// The newest of the train at `t_s`.
[[nodiscard]] CoilPulse PulseAt(const CoilPulseConfig& config, double t_s);

/// What the source says that it does at `t_s`; in the train, or `pulse` being its newest.
[[nodiscard]] sensing::CoilDrive StatedDrive(const CoilPulseConfig& config, double t_s);
[[nodiscard]] sensing::CoilDrive StatedDrive(const CoilPulseConfig& config, const CoilPulse& pulse,
                                             double t_s);

/// The current that flows at `t_s`, and in which coil:
///   i(t) = i₁ + (i₀ − i₁) exp(−(t − t_edge)/τ)
/// with L/R = τ, from one edge to the next.
struct CoilCurrent {
  int coil = -1;
  double current_a = 0.0;
};
[[nodiscard]] CoilCurrent TrueCurrent(const CoilPulseConfig& config, double t_s);
/// The same by the source's clock, `pulse` being its newest.
[[nodiscard]] CoilCurrent TrueCurrent(const CoilPulseConfig& config, const CoilPulse& pulse,
                                      double t_s);

}  // namespace limbcast::simulation
