#include "services/gateway/drivers/simulator/simulated_coils.hpp"

#include <array>
#include <string>

#include "common/simulation/random.hpp"

namespace limbcast::gateway {
namespace {

constexpr double kTeslaPerNanotesla = 1e-9;
constexpr double kFarthest_m = 10.0;

}  // namespace

SimulatedCoilsConfig ReadSimulatedCoils(const config::Section& section,
                                        SimulatedCoilsConfig config) {
  constexpr std::size_t kMaxName = 64;
  if (const std::string name = section.Read("source", "", kMaxName); !name.empty()) {
    if (const auto segment = body::ParseSegment(name)) {
      config.source = *segment;
    } else {
      section.Fail("source", "must be a segment like pelvis, is '" + name + "'");
    }
  }
  if (section.Has("sensors")) {
    config.sensors.clear();
    for (const std::string& name : section.Read("sensors", std::vector<std::string>())) {
      if (const auto segment = body::ParseSegment(name)) {
        config.sensors.push_back(*segment);
      } else {
        section.Fail("sensors", "must be segments like right_fore_arm, has '" + name + "'");
      }
    }
  }
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
  struct Range {
    const char* name;
    double value, low, high;
  };
  const std::array ranges = {
      Range{"radius_m", config.coils.radius_m, 0.005, 1.0},
      Range{"turns", config.coils.turns, 1.0, 1e4},
      Range{"current_a", config.current_a, 0.01, 20.0},
      Range{"slots", static_cast<double>(config.slots), 1.0, 100.0},
      Range{"slot_s", config.slot_s, 0.02, 2.0},
      Range{"clock_error_s", config.clock_error_s, 0.0, 0.05},
      Range{"mag_noise_tesla", config.mag_noise_tesla, 0.0, 1e-6},
  };
  for (const Range& range : ranges) {
    if (!(range.value >= range.low && range.value <= range.high)) {
      return Error{ErrorCode::kInvalidArgument, std::string("simulator.coils.") + range.name +
                                                    " must be in [" + std::to_string(range.low) +
                                                    ", " + std::to_string(range.high) + "], is " +
                                                    std::to_string(range.value)};
    }
  }
  const double busy_s = (config.bipolar ? 2.0 : 1.0) * config.plateau_s + config.settling_s +
                        2.0 * config.clock_error_s;
  if (busy_s > config.slot_s) {
    return Error{ErrorCode::kInvalidArgument,
                 "simulator.coils.slot_s must hold pulse, settling and twice the clock error, " +
                     std::to_string(busy_s) + " s, is " + std::to_string(config.slot_s)};
  }
  if (const Status pulses = simulation::Validate(PulsesOf(config, 0, 0)); !pulses) {
    return Error{pulses.error().code, "simulator.coils: " + pulses.error().message};
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

simulation::TriadErrors CoilMagErrors(const SimulatedCoilsConfig& config) {
  return {.noise = config.mag_noise_tesla,
          .scale = 1e-3,
          .misalignment = 1e-3,
          .range = 1300e-6,
          .resolution = 5e-9};
}

Eigen::Vector3d FieldOf_tesla(const sensing::CoilSource& coils, const ActiveCoil& active,
                              const Eigen::Vector3d& p_earth_m) {
  const Eigen::Vector3d p_E_m = p_earth_m - active.emitter.p_earth_local_m;
  if (active.current.coil < 0 || active.current.current_a == 0.0 || p_E_m.norm() > kFarthest_m) {
    return Eigen::Vector3d::Zero();
  }
  return active.emitter.R_earth_local *
         sensing::CoilField(coils, active.current.coil, active.current.current_a,
                            active.emitter.R_earth_local.transpose() * p_E_m)
             .field_tesla;
}

}  // namespace limbcast::gateway
