#pragma once

#include <cstdint>
#include <string>

#include "common/base/result.hpp"
#include "common/config/config_file.hpp"
#include "common/simulation/marg_model.hpp"
#include "common/simulation/random.hpp"
#include "common/simulation/sensor_set.hpp"
#include "services/gateway/drivers/simulator/fault_injector.hpp"
#include "services/gateway/drivers/simulator/simulated_cameras.hpp"
#include "services/gateway/drivers/simulator/simulated_coils.hpp"

namespace limbcast::gateway {

enum class SimulatedMotion : std::uint8_t {
  kDefault,   ///< simulation::MakeDefaultSchedule
  kStanding,  ///< N-pose for ever
};

/// What to simulate. Section [simulator]; keys as the fields, except where said.
struct SimulatorConfig {
  /// People, with the body ids 1, 2, ... Range: [1, 256].
  std::uint32_t persons = 1;

  /// Ticks a second. Range: [1, 1000].
  double rate_hz = 100.0;

  /// Key `sensors`: "reduced15", "standard17" or "all23".
  simulation::SensorSet sensors = simulation::SensorSet::kStandard17;

  /// End after this long; 0 = never. Range: [0, 1e7].
  double duration_s = 0.0;

  /// Same seed, same numbers. Range: [0, 2^62].
  std::uint64_t seed = simulation::kDefaultSeed;

  /// "ideal", "default" or "poor".
  simulation::NoisePreset noise = simulation::NoisePreset::kDefault;

  /// How sensors are turned on their segments: "aligned", "rough" (15°) or "arbitrary".
  simulation::MountingStyle mounting = simulation::MountingStyle::kArbitrary;

  /// "default" (stand, walk, gestures, sit, turn) or "standing".
  SimulatedMotion motion = SimulatedMotion::kDefault;

  /// Time in N-pose before the rest. Range: [0.5, 3600].
  double n_pose_s = 5.0;

  /// Way faced at the begin, counter-clockwise from east; key `facing_deg`. Range: ±360°.
  double facing_rad = 0.0;

  /// Range: [1.2, 2.2].
  double height_m = 1.75;

  /// Distance of people from one another. Range: [1, 1000].
  double spacing_m = 10.0;

  /// Iron beside and under the way.
  bool iron = true;

  /// Off: no magnetometers, readings flagged missing.
  bool magnetometer = true;

  /// In front of every serial number: tells apart two simulators in one session. At most 16
  /// characters.
  std::string serial_prefix = "sim";

  /// [simulator.faults]: not_finite_rate, saturated_rate, duplicate_rate, out_of_order_rate,
  /// gap_rate, mag_missing_rate, gap_ticks; and [[simulator.faults.list]] {tick, body, segment,
  /// fault}.
  FaultConfig faults;

  SimulatedCoilsConfig coils{};      ///< [simulator.coils]
  SimulatedCamerasConfig cameras{};  ///< [simulator.cameras]
};

/// Reads [simulator]; refusals are remembered in the section's file.
[[nodiscard]] SimulatorConfig ReadSimulatorConfig(const config::Section& section,
                                                  SimulatorConfig defaults = {});

[[nodiscard]] Status Validate(const SimulatorConfig& config);

}  // namespace limbcast::gateway
