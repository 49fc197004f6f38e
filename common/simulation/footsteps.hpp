#pragma once

#include <vector>

#include "common/simulation/jet.hpp"
#include "common/simulation/motion_schedule.hpp"
#include "common/simulation/person_shape.hpp"

namespace limbcast::simulation {

/// One foot at one instant. On the ground a foot turns about its heel or its toe joint, or stands
/// flat: it never slides.
struct FootMotion {
  Jet3 p_earth_ankle_m;
  Jet heading_rad;
  Jet pitch_rad;         ///< of the foot, positive with the heel up
  Jet toe_pitch_rad;     ///< of the toes, in the earth frame
  bool contact = false;  ///< some part of the foot rests on the ground
};

/// Where the feet of one phase stand and when: for each step the foot is put where the person's
/// path will be kPlacementLead steps after landing.
class Footsteps {
 public:
  Footsteps(const TimedPhase& phase, const PersonShape& shape);

  [[nodiscard]] FootMotion At(const TimedPhase& phase, Side side, const Jet& since_s) const;

 private:
  struct Placement {
    double x_m = 0.0;
    double y_m = 0.0;
    double heading_rad = 0.0;
    double roll = 0.0;  ///< how much of a full stride led here: scales heel rise and heel strike
  };
  [[nodiscard]] Placement Standing(const FloorPose& where, Side side) const;
  [[nodiscard]] FootMotion Swinging(const Placement& from, const Placement& to,
                                    const Jet& steps_since_lift) const;

  PersonShape shape_;
  std::vector<Placement> placements_;  // two initial (right, left), then one for each step
};

}  // namespace limbcast::simulation
