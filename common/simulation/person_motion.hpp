#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "common/base/result.hpp"
#include "common/body/segment.hpp"
#include "common/simulation/footsteps.hpp"
#include "common/simulation/gait_phase.hpp"
#include "common/simulation/motion_schedule.hpp"
#include "common/simulation/person_shape.hpp"
#include "common/simulation/rigid_motion.hpp"

namespace limbcast::simulation {

/// Where a person begins and what it does then.
struct PersonMotionConfig {
  MotionSchedule schedule = MakeDefaultSchedule();
  /// The place, and the way, in which the schedule begins; x east, y north.
  FloorPose start{};
};

/// All segments of a person at one instant.
struct PersonPose {
  /// Inboard end, orientation and their derivatives in the earth frame, by body::Index.
  std::array<RigidMotion, body::kSegmentCount> segments;
  std::uint32_t contacts = 0;  ///< bit i set: segment i (feet) is on the ground
};

/// A moving person as a function of time: every position, rate and acceleration it gives belongs to
/// one motion with three continuous derivatives (two in the swinging foot). The floor is z = 0.
/// Holds no time of its own: ask for any instant, in any order. Thread-compatible; At is const and
/// may be called from several threads.
class PersonMotion {
 public:
  /// Fails as Validate(schedule) does.
  [[nodiscard]] static Result<PersonMotion> Make(const PersonShape& shape,
                                                 const PersonMotionConfig& config);

  /// The person `t_s` seconds after its begin (negative counts as 0). Allocates nothing.
  [[nodiscard]] PersonPose At(double t_s) const;

  [[nodiscard]] const PersonShape& shape() const { return shape_; }
  [[nodiscard]] const Timeline& timeline() const { return timeline_; }

 private:
  PersonMotion(const PersonShape& shape, Timeline timeline);

  PersonShape shape_;
  Timeline timeline_;
  std::vector<Footsteps> footsteps_;  // one for each phase of the timeline
};

}  // namespace limbcast::simulation
