#include "services/gateway/drivers/simulator/simulated_coils.hpp"

#include <string>

#include "common/base/range.hpp"
#include "common/config/named_values.hpp"
#include "common/simulation/coil_stream.hpp"
#include "common/simulation/random.hpp"

namespace limbcast::gateway {
namespace {

constexpr double kTeslaPerNanotesla = 1e-9;
constexpr double kFarthest_m = 10.0;

}  // namespace

SimulatedCoilsConfig ReadSimulatedCoils(const config::Section& section,
                                        SimulatedCoilsConfig config) {
  config.source = config::ReadNamedIfAny(section, "source", config.source, body::ParseSegment,
                                         "a segment like pelvis");
  config.sensors = config::ReadNamedList(section, "sensors", config.sensors, body::ParseSegment,
                                         "segments like right_fore_arm");
  config.coils.radius_m = section.Read("radius_m", config.coils.radius_m, 0.005, 1.0);
  config.coils.turns = section.Read("turns", config.coils.turns, 1.0, 1e4);
  config.current_a = section.Read("current_a", config.current_a, 0.01, 20.0);
  config.plateau_s = section.Read("plateau_s", config.plateau_s, 0.01, 1.0);
  config.bipolar = section.Read("bipolar", config.bipolar);
  config.settling_s = section.Read("settling_s", config.settling_s, 0.0, 0.05);
  config.time_constant_s = section.Read("time_constant_s", config.time_constant_s, 0.0, 0.01);
  config.slots = section.Read("slots", config.slots, 1U, 100U);
  config.slot_s = section.Read("slot_s", config.slot_s, 0.02, 2.0);
  config.clock_error_s = section.Read("clock_error_s", config.clock_error_s, 0.0, 0.05);
  config.mag_noise_tesla =
      kTeslaPerNanotesla *
      section.Read("mag_noise_nt", config.mag_noise_tesla / kTeslaPerNanotesla, 0.0, 1000.0);
  return config;
}

Status Validate(const SimulatedCoilsConfig& config) {
  if (!config.source) {
    return Ok();
  }
  Status ranges =
      CheckRanges("simulator.coils.", {{"radius_m", config.coils.radius_m, 0.005, 1.0},
                                       {"turns", config.coils.turns, 1.0, 1e4},
                                       {"current_a", config.current_a, 0.01, 20.0},
                                       {"slots", static_cast<double>(config.slots), 1.0, 100.0},
                                       {"slot_s", config.slot_s, 0.02, 2.0},
                                       {"clock_error_s", config.clock_error_s, 0.0, 0.05},
                                       {"mag_noise_tesla", config.mag_noise_tesla, 0.0, 1e-6}});
  if (!ranges) {
    return ranges;
  }
  const simulation::CoilPulseConfig pulses = PulsesOf(config, 0, 0);
  const double busy_s = LeastSlot_s(config);
  if (busy_s > config.slot_s) {
    return Error{ErrorCode::kInvalidArgument,
                 "simulator.coils.slot_s must hold pulse, settling and twice the clock error, " +
                     std::to_string(busy_s) + " s, is " + std::to_string(config.slot_s)};
  }
  if (const Status valid = simulation::Validate(pulses); !valid) {
    return Error{valid.error().code, "simulator.coils: " + valid.error().message};
  }
  return Ok();
}

simulation::CoilPulseConfig PulsesOf(const SimulatedCoilsConfig& config, std::uint32_t index,
                                     std::uint64_t seed) {
  constexpr double kQuietAtFirst_s = 0.5;
  simulation::CoilPulseConfig pulses;
  pulses.cycle_s = config.cycle_s();
  pulses.plateau_s = config.plateau_s;
  pulses.bipolar = config.bipolar;
  pulses.current_a = config.current_a;
  pulses.settling_s = config.settling_s;
  pulses.time_constant_s = config.time_constant_s;
  pulses.begin_s = kQuietAtFirst_s + config.slot_s * (index % config.slots);
  pulses.clock_error_s =
      simulation::Random(seed, "coil clock").Uniform(-config.clock_error_s, config.clock_error_s);
  return pulses;
}

double LeastSlot_s(const SimulatedCoilsConfig& config) {
  return simulation::PulseLength_s(PulsesOf(config, 0, 0)) + config.settling_s +
         2.0 * config.clock_error_s;
}

simulation::TriadErrors CoilMagErrors(const SimulatedCoilsConfig& config) {
  return {.noise = config.mag_noise_tesla,
          .scale = 1e-3,
          .misalignment = 1e-3,
          .range = 1300e-6,
          .resolution = 5e-9};
}

Eigen::Vector3d FieldOf_tesla(const sensing::CoilSource& coils, const ActiveCoil& active,
                              const Eigen::Vector3d& p_earth_m) {
  if ((p_earth_m - active.emitter.p_earth_local_m).norm() > kFarthest_m) {
    return Eigen::Vector3d::Zero();
  }
  return simulation::SourceField_tesla(coils, active.current, active.emitter, p_earth_m);
}

}  // namespace limbcast::gateway
