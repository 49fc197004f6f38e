#include "tests/unit/common/filters/position/coil_scene.hpp"

#include <limits>

#include "common/simulation/jet.hpp"
#include "common/simulation/smooth_step.hpp"

namespace limbcast::filters {

simulation::CoilStreamConfig SwingStream(bool moving_source,
                                         const simulation::CoilPulseConfig& pulses) {
  using simulation::Jet;
  const auto emitter = [moving_source](double t_s) {
    const Jet t = Jet::Variable(t_s);
    const Jet on = moving_source ? simulation::SmoothStep(t, 2.5, 4.0) : Jet(0.0);
    simulation::RigidMotion motion = simulation::MovingPoint(
        {on * (0.05 * simulation::Sin(3.0 * t)), on * (0.04 * simulation::Cos(2.3 * t)), 1.0});
    simulation::RotateAbout(motion, 2, 0.4 + on * (0.3 * simulation::Sin(1.7 * t)));
    simulation::RotateAbout(motion, 0, on * (0.15 * simulation::Sin(2.9 * t)));
    return motion;
  };
  simulation::CoilStreamConfig stream;
  stream.pulses = pulses;
  stream.emitter = emitter;
  stream.emitter_inertial = moving_source;
  stream.sensor = [emitter](double t_s) {
    const Jet t = Jet::Variable(t_s);
    const Jet on = simulation::SmoothStep(t, 2.5, 4.0);
    simulation::RigidMotion motion = simulation::AtPoint(emitter(t_s), {0.05, 0.0, 0.1});
    simulation::RotateAbout(motion, 1, 0.2 + on * (0.5 * simulation::Sin(1.9 * t)));
    simulation::RotateAbout(motion, 0, on * (0.4 * simulation::Cos(1.3 * t)));
    motion = simulation::AtPoint(motion, {0.0, 0.05, 0.22});
    simulation::RotateAbout(motion, 2, on * (0.6 * simulation::Sin(2.2 * t)));
    return motion;
  };
  stream.errors = simulation::CoilSensorErrors(50e-9);
  stream.gradient_tesla_m.diagonal() = Eigen::Vector3d(2e-7, -3e-7, 1e-7);
  return stream;
}

std::vector<simulation::CoilTick> SwingingSensor(bool moving_source,
                                                 const simulation::CoilPulseConfig& pulses,
                                                 double duration_s, std::uint64_t seed) {
  return simulation::SimulateCoil(SwingStream(moving_source, pulses), duration_s, seed);
}

void SpoilFrames(std::vector<simulation::CoilTick>& ticks, std::size_t first) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  for (std::size_t k = first; k < ticks.size(); ++k) {
    sensing::CoilFrame& frame = ticks[k].frame;
    if (k % 97 == 0) {
      frame.mag_tesla.y() = nan;
    }
    if (k % 101 == 0) {
      frame.accel_m_s2.x() = nan;
    }
    if (k % 103 == 0) {
      frame.mag_valid = false;
      frame.mag_tesla.setConstant(150e-6);
    }
    if (k % 107 == 0) {
      frame.measured_at = ticks[k - 1].frame.measured_at;
    }
  }
}

CoilInertialConfig SwingConfig() {
  CoilInertialConfig config;
  config.half_space = Eigen::Vector3d::UnitZ();
  return config;
}

}  // namespace limbcast::filters
