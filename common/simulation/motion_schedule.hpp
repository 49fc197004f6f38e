#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "common/base/result.hpp"
#include "common/simulation/ground_path.hpp"

namespace limbcast::simulation {

enum class PhaseKind : std::uint8_t {
  kNPose,  ///< exactly upright, arms hanging, every segment the identity but for the heading
  kStand,  ///< relaxed
  kWalk,   ///< along `path`
  kTurn,   ///< by `turn_rad`, stepping on the spot
  kSit,    ///< sits down, sits, gets up again
};

enum class GestureKind : std::uint8_t {
  kRaiseFront,  ///< arm forward and up, to 150°
  kRaiseSide,   ///< arm sideways and up, to 130°
  kWave,        ///< upper arm out, fore arm up, waving
  kWindmill,    ///< a full turn about the shoulder
  kReach,       ///< forward, elbow pumping, fore arm turning
  kTwist,       ///< trunk left and right
  kBow,         ///< trunk forward and back
  kLook,        ///< head left and right, up and down
};

enum class Side : std::uint8_t { kRight = 0, kLeft = 1, kBoth = 2 };

/// Something done beside the phase, `start_s` after its begin.
struct Gesture {
  GestureKind kind = GestureKind::kRaiseFront;
  Side side = Side::kBoth;
  double start_s = 0.0;
  double duration_s = 3.0;  ///< range: [1, 60]; must end within the phase
};

/// One thing after the other. The person comes to rest between phases.
struct Phase {
  PhaseKind kind = PhaseKind::kStand;
  double duration_s = 5.0;  ///< not for kWalk, whose path decides. Range: [0.5, 3600]; kSit: ≥ 5
  /// kWalk: from where and how the person stands. Pieces [0.1, 1000] m long; at least 1 m in all;
  /// bends no tighter than 0.6 m (turn_rad·1.875/length_m ≤ 1/0.6).
  std::vector<PathPiece> path{};
  double speed_m_s = 1.1;  ///< kWalk. Range: [0.3, 1.6]
  double turn_rad = 0.0;   ///< kTurn. Range: [−2π, 2π]
  std::vector<Gesture> gestures{};
};

/// What a person does. After the last phase it goes on with phase `repeat_from`; the person must
/// then stand where it stood at the first begin of that phase.
struct MotionSchedule {
  std::vector<Phase> phases;
  std::size_t repeat_from = 0;
};

/// N-pose (5 s); a walk of about 20 m with turns to both sides and gestures; gestures standing;
/// sitting; a walk the other way round; turning on the spot; and on from the first walk, for ever.
/// `n_pose_s` in [0.5, 3600].
[[nodiscard]] MotionSchedule MakeDefaultSchedule(double n_pose_s = 5.0);

/// Stands in N-pose for ever.
[[nodiscard]] MotionSchedule MakeStandingSchedule();

/// The first range that is not kept.
[[nodiscard]] Status Validate(const MotionSchedule& schedule);

/// Step k of a walk or turn (even: right) lifts its foot k + kFirstLift steps after the begin; the
/// last foot is flat kFirstLift steps after the last whole one.
inline constexpr double kFirstLift = 0.6;

/// A phase with all that follows from the ones before it.
struct TimedPhase {
  Phase phase;
  bool unlocks = false;  ///< the second from N-pose to relaxed (kind is kNPose)
  bool locks = false;    ///< the second from relaxed to N-pose (kind is kNPose)
  double start_s = 0.0;
  double end_s = 0.0;
  FloorPose from;
  FloorPose to;
  GroundPath path;      ///< kWalk
  double ramp_s = 0.0;  ///< kWalk: time to gather speed
  double step_s = 0.0;  ///< kWalk, kTurn: time of one step
  int steps = 0;        ///< kWalk, kTurn
  double step_length_m = 0.0;

  [[nodiscard]] double duration_s() const { return end_s - start_s; }
};

/// The phases on the clock.
class Timeline {
 public:
  /// The schedule begun at `start`. Fails as Validate does.
  [[nodiscard]] static Result<Timeline> Make(const MotionSchedule& schedule,
                                             const FloorPose& start = {});

  struct Place {
    const TimedPhase* phase = nullptr;
    Jet since_s;  ///< time since the phase began, d/dt = 1
  };
  /// t_s < 0 counts as 0.
  [[nodiscard]] Place At(double t_s) const;
  [[nodiscard]] const std::vector<TimedPhase>& phases() const { return phases_; }
  [[nodiscard]] double repeat_from_s() const { return repeat_from_s_; }

 private:
  std::vector<TimedPhase> phases_;
  double repeat_from_s_ = 0.0;
};

/// The place of the person on the floor (the middle under the hips while standing) `since_s` after
/// the begin of the phase.
[[nodiscard]] MovingFloorPose FloorPoseAt(const TimedPhase& phase, const Jet& since_s);

}  // namespace limbcast::simulation
