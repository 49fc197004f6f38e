#pragma once

#include "common/simulation/motion_schedule.hpp"

namespace limbcast::simulation {

/// Part of a step that a foot is in the air: 40 % of a stride of two steps (Perry, "Gait
/// Analysis").
inline constexpr double kSwing = 0.8;

/// Where in its gait a person is. All zero and still outside of kWalk and kTurn.
struct GaitPhase {
  Jet steps;   ///< steps since the first foot lifted
  Jet amount;  ///< 0 standing, 1 in full swing

  /// cos(π·(steps − at)): +1 when right-foot steps are `at`, −1 when left-foot steps are.
  [[nodiscard]] Jet Alternating(double at) const;
  /// cos(2π·(steps − at)): +1 at the same instant of every step.
  [[nodiscard]] Jet EveryStep(double at) const;
};

[[nodiscard]] GaitPhase GaitPhaseAt(const TimedPhase& phase, const Jet& since_s);

}  // namespace limbcast::simulation
