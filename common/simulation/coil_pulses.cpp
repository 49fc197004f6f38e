#include "common/simulation/coil_pulses.hpp"

#include <cmath>

namespace limbcast::simulation {

double PulseLength_s(const CoilPulseConfig& config) {
  return config.bipolar ? 2.0 * config.plateau_s : config.plateau_s;
}

Status Validate(const CoilPulseConfig& c) {
  const auto within = [](double x, double low, double high) { return x >= low && x <= high; };
  if (!within(c.cycle_s, 0.05, 60.0)) {
    return Error{ErrorCode::kInvalidArgument, "coil.cycle_s must be in [0.05, 60]"};
  }
  if (!within(c.plateau_s, 0.01, 1.0) || PulseLength_s(c) + c.settling_s > c.cycle_s / 3.0) {
    return Error{ErrorCode::kInvalidArgument,
                 "coil.plateau_s must be in [0.01, 1] and the pulse must fit in cycle_s / 3"};
  }
  if (!within(c.current_a, 1e-6, 20.0)) {
    return Error{ErrorCode::kInvalidArgument, "coil.current_a must be in (0, 20]"};
  }
  if (!within(c.settling_s, 0.0, 0.05) || !within(c.time_constant_s, 0.0, 0.01)) {
    return Error{ErrorCode::kInvalidArgument,
                 "coil.settling_s must be in [0, 0.05], coil.time_constant_s in [0, 0.01]"};
  }
  return Ok();
}

CoilPulseConfig ThesisPulses() { return {}; }

CoilPulseConfig BipolarPulses() {
  CoilPulseConfig config;
  config.plateau_s = 0.017;
  config.bipolar = true;
  return config;
}

CoilPulse PulseAt(const CoilPulseConfig& config, double t_s) {
  const double spacing_s = config.cycle_s / 3.0;
  constexpr double kRounding_s = 1e-9;  // a sample exactly at an edge is after it
  const double since_begin_s = t_s - config.begin_s + kRounding_s;
  if (since_begin_s < 0.0) {
    return {};
  }
  const double number = std::floor(since_begin_s / spacing_s);
  return {.coil = static_cast<int>(std::fmod(number, 3.0)),
          .begin_s = t_s - (since_begin_s - number * spacing_s),
          .current_a = config.current_a};
}

sensing::CoilDrive StatedDrive(const CoilPulseConfig& config, const CoilPulse& pulse, double t_s) {
  sensing::CoilDrive drive;
  if (pulse.coil < 0) {
    return drive;
  }
  const double since_s = t_s - pulse.begin_s;
  const double length_s = PulseLength_s(config);
  if (since_s >= length_s) {
    drive.settled = since_s >= length_s + config.settling_s;
    return drive;
  }
  const bool second = since_s >= config.plateau_s;
  drive.coil = pulse.coil;
  drive.current_a = second ? -pulse.current_a : pulse.current_a;
  drive.settled = since_s - (second ? config.plateau_s : 0.0) >= config.settling_s;
  return drive;
}

sensing::CoilDrive StatedDrive(const CoilPulseConfig& config, double t_s) {
  return StatedDrive(config, PulseAt(config, t_s), t_s);
}

CoilCurrent TrueCurrent(const CoilPulseConfig& config, const CoilPulse& pulse, double t_s) {
  if (pulse.coil < 0) {
    return {};
  }
  const auto decayed = [&](double since_s) {
    return config.time_constant_s > 0.0 ? std::exp(-since_s / config.time_constant_s) : 0.0;
  };
  const double i = pulse.current_a;
  const double since_s = t_s - pulse.begin_s;
  const double length_s = PulseLength_s(config);
  double current_a = 0.0;
  if (since_s < config.plateau_s) {
    current_a = i * (1.0 - decayed(since_s));
  } else if (since_s < length_s) {
    current_a = -i + 2.0 * i * decayed(since_s - config.plateau_s);
  } else {
    current_a = (config.bipolar ? -i : i) * decayed(since_s - length_s);
  }
  return {pulse.coil, current_a};
}

CoilCurrent TrueCurrent(const CoilPulseConfig& config, double t_s) {
  const double at_source_s = t_s - config.clock_error_s;
  return TrueCurrent(config, PulseAt(config, at_source_s), at_source_s);
}

}  // namespace limbcast::simulation
