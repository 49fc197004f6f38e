#pragma once

#include <Eigen/Core>

#include "common/simulation/jet.hpp"
#include "common/simulation/rigid_motion.hpp"

namespace limbcast::simulation {

/// Angles of a right arm as functions of time, rad. All zero: the arm lies straight along x.
struct ArmAngles {
  Jet heading{};    ///< of the whole person, counter-clockwise
  Jet flexion{};    ///< of the shoulder, from along x upwards
  Jet abduction{};  ///< of the shoulder, then to the right
  Jet elbow{};      ///< flexion: the fore arm from along the upper arm upwards
  Jet pronation{};  ///< of the fore arm about itself
};

/// An arm at a shoulder that may move.
struct Arm {
  double upper_m = 0.29;
  double fore_m = 0.25;
};

/// The wrist, with axes of the fore arm (x along it to the hand, z up when all angles are 0):
/// shoulder, heading about z, flexion about −y, abduction about −z, along the upper arm, elbow
/// about −y, pronation about x, along the fore arm.
[[nodiscard]] RigidMotion WristOf(const Arm& arm, const Jet3& p_earth_shoulder_m,
                                  const ArmAngles& angles_rad);

}  // namespace limbcast::simulation
