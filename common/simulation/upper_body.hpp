#pragma once

#include <array>

#include "common/simulation/gait_phase.hpp"
#include "common/simulation/motion_schedule.hpp"

namespace limbcast::simulation {

/// Joint angles of one arm; all zero: hanging, palm inwards. Positive as named on both sides.
struct ArmAngles {
  Jet shrug_rad;      ///< shoulder girdle up
  Jet flexion_rad;    ///< arm forward
  Jet abduction_rad;  ///< arm away from the body
  Jet axial_rad;      ///< upper arm turned inwards
  Jet elbow_rad;      ///< flexion
  Jet pronation_rad;  ///< palm back
  Jet wrist_rad;      ///< palmar flexion
};

/// Joint angles above the pelvis; all zero: upright.
struct UpperBodyAngles {
  Jet trunk_yaw_rad;              ///< T8 to the left, shared by the four joints below it
  Jet trunk_flex_rad;             ///< forward
  Jet trunk_side_rad;             ///< to the right
  Jet head_yaw_rad;               ///< to the left, shared by neck and head
  Jet head_pitch_rad;             ///< nodding forward
  std::array<ArmAngles, 2> arms;  ///< by Side: right, left
};

/// What trunk, head and arms do: arm swing and counter-rotation with the gait, small sway, and the
/// gestures of the phase. `relaxed` is 0 in N-pose (then everything is zero) and 1 else; `t_s` runs
/// on over all phases and drives the sway.
[[nodiscard]] UpperBodyAngles UpperBodyAt(const TimedPhase& phase, const Jet& since_s,
                                          const GaitPhase& gait, const Jet& relaxed,
                                          const Jet& t_s);

}  // namespace limbcast::simulation
