#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "common/base/result.hpp"
#include "common/body/segment.hpp"
#include "common/config/config_file.hpp"
#include "common/sensing/coil_field.hpp"
#include "common/simulation/coil_pulses.hpp"
#include "common/simulation/marg_model.hpp"
#include "common/simulation/rigid_motion.hpp"

namespace limbcast::gateway {

/// A source of three coils on each person: section [simulator.coils]; keys as the fields, except
/// where said.
struct SimulatedCoilsConfig {
  /// Key `source`: the segment whose sensor carries the coils, "" = nobody wears any.
  std::optional<body::Segment> source = std::nullopt;

  /// Key `sensors`: segments whose sensors are tracked; those that carry none are left out.
  std::vector<body::Segment> sensors = {body::Segment::kRightForeArm, body::Segment::kLeftForeArm,
                                        body::Segment::kRightLowerLeg,
                                        body::Segment::kLeftLowerLeg};

  sensing::CoilSource coils{};  ///< keys radius_m, turns
  double current_a = 1.5;       ///< Range: [0.01, 20]
  double plateau_s = 0.03;      ///< of each polarity. Range: [0.01, 1]
  bool bipolar = true;
  double settling_s = 0.0085;       ///< after each edge. Range: [0, 0.05]
  double time_constant_s = 0.0012;  ///< L/R. Range: [0, 0.01]
  /// Sources pulse in turn: slot k belongs to persons k, k + slots, ... Each slot takes one pulse,
  /// each source pulses X, Y, Z in three rounds. Range: [1, 100]. What a session host grants goes
  /// before these two.
  std::uint32_t slots = 2;
  double slot_s = 0.1;             ///< pulse, settling and guard. Range: [0.02, 2]
  double clock_error_s = 0.0;      ///< each source is late by up to ± this. Range: [0, 0.05]
  double mag_noise_tesla = 15e-9;  ///< key `mag_noise_nt`, of every magnetometer. Range: [0, 1e-6]

  [[nodiscard]] double cycle_s() const { return 3.0 * slots * slot_s; }
};

/// Reads [simulator.coils]; refusals are remembered in the section's file.
[[nodiscard]] SimulatedCoilsConfig ReadSimulatedCoils(const config::Section& section,
                                                      SimulatedCoilsConfig defaults);
[[nodiscard]] Status Validate(const SimulatedCoilsConfig& config);

/// The pulses of person `index`, its clock error drawn from `seed`.
[[nodiscard]] simulation::CoilPulseConfig PulsesOf(const SimulatedCoilsConfig& config,
                                                   std::uint32_t index, std::uint64_t seed);

/// How long a slot must be for these pulses.
[[nodiscard]] double LeastSlot_s(const SimulatedCoilsConfig& config);

/// Magnetometers of people who wear coils: calibrated, and as quiet as the configuration says.
[[nodiscard]] simulation::TriadErrors CoilMagErrors(const SimulatedCoilsConfig& config);

/// A source at one instant: where its coils are, and the current that flows in one of them.
struct ActiveCoil {
  simulation::RigidMotion emitter;
  simulation::CoilCurrent current;
};

/// Its field at a point of the earth frame. Sources farther than 10 m away are left out: 0.1 nT.
[[nodiscard]] Eigen::Vector3d FieldOf_tesla(const sensing::CoilSource& coils,
                                            const ActiveCoil& active,
                                            const Eigen::Vector3d& p_earth_m);

}  // namespace limbcast::gateway
