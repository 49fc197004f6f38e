#include "common/simulation/gait_phase.hpp"

#include <algorithm>
#include <numbers>

#include "common/simulation/smooth_step.hpp"

namespace limbcast::simulation {

Jet GaitPhase::Alternating(double at) const { return Cos(std::numbers::pi * (steps - at)); }

Jet GaitPhase::EveryStep(double at) const { return Cos(2.0 * std::numbers::pi * (steps - at)); }

GaitPhase GaitPhaseAt(const TimedPhase& phase, const Jet& since_s) {
  if (phase.steps == 0) {
    return {};
  }
  GaitPhase gait;
  gait.steps = since_s * (1.0 / phase.step_s) - kFirstLift;
  gait.amount = Window(since_s, 0.0, phase.duration_s(), 2.0 * phase.step_s);
  return gait;
}

}  // namespace limbcast::simulation
