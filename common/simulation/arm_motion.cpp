#include "common/simulation/arm_motion.hpp"

namespace limbcast::simulation {
namespace {

constexpr int kX = 0;
constexpr int kY = 1;
constexpr int kZ = 2;

}  // namespace

RigidMotion WristOf(const Arm& arm, const Jet3& p_earth_shoulder_m, const ArmAngles& angles_rad) {
  RigidMotion frame = MovingPoint(p_earth_shoulder_m);
  RotateAbout(frame, kZ, angles_rad.heading);
  RotateAbout(frame, kY, -angles_rad.flexion);
  RotateAbout(frame, kZ, -angles_rad.abduction);
  RigidMotion fore = AtPoint(frame, {arm.upper_m, 0.0, 0.0});
  RotateAbout(fore, kY, -angles_rad.elbow);
  RotateAbout(fore, kX, angles_rad.pronation);
  return AtPoint(fore, {arm.fore_m, 0.0, 0.0});
}

}  // namespace limbcast::simulation
