#include "common/simulation/motion_schedule.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>

#include "common/simulation/smooth_step.hpp"

namespace limbcast::simulation {
namespace {

constexpr double kPi = std::numbers::pi;
constexpr double kLockTime_s = 1.0;
constexpr double kTightestBend_m = 0.6;

Error Invalid(std::size_t index, const std::string& what) {
  return Error{ErrorCode::kInvalidArgument,
               "schedule phase " + std::to_string(index + 1) + ": " + what};
}

bool InRange(double value, double low, double high) { return value >= low && value <= high; }

Status ValidatePhase(const Phase& phase, std::size_t i) {
  if (phase.kind == PhaseKind::kWalk) {
    if (phase.path.empty()) {
      return Invalid(i, "a walk needs a path");
    }
    if (!InRange(phase.speed_m_s, 0.3, 1.6)) {
      return Invalid(i, "speed_m_s must be in [0.3, 1.6], is " + std::to_string(phase.speed_m_s));
    }
  } else if (!InRange(phase.duration_s, phase.kind == PhaseKind::kSit ? 5.0 : 0.5, 3600.0)) {
    return Invalid(i, "duration_s must be in [0.5, 3600] (sitting: at least 5), is " +
                          std::to_string(phase.duration_s));
  }
  if (!InRange(phase.turn_rad, -2.0 * kPi, 2.0 * kPi)) {
    return Invalid(i, "turn_rad must be in [-2 pi, 2 pi], is " + std::to_string(phase.turn_rad));
  }
  return Ok();
}

Status ValidateGestures(const TimedPhase& timed, std::size_t i) {
  for (const Gesture& gesture : timed.phase.gestures) {
    if (timed.phase.kind == PhaseKind::kNPose) {
      return Invalid(i, "no gestures in N-pose");
    }
    if (!InRange(gesture.duration_s, 1.0, 60.0) || !(gesture.start_s >= 0.0) ||
        gesture.start_s + gesture.duration_s > timed.duration_s() + 1e-9) {
      return Invalid(i, "a gesture of " + std::to_string(gesture.duration_s) + " s at " +
                            std::to_string(gesture.start_s) + " s must last 1 to 60 s and end by " +
                            std::to_string(timed.duration_s()) + " s");
    }
  }
  return Ok();
}

// Time of one step: cadence grows with the root of the speed (Grieve & Gear 1966), 1.85 steps a
// second at 1.1 m/s.
double StepTime_s(double speed_m_s) { return 1.0 / (1.85 * std::sqrt(speed_m_s / 1.1)); }

void PlanSteps(TimedPhase& timed, double wished_duration_s, double step_s) {
  // Time to rise on the toes before the first step, and the last foot is flat exactly at the end.
  timed.steps = std::max(4, static_cast<int>(std::lround(wished_duration_s / step_s - kFirstLift)));
  timed.step_s = step_s;
  timed.end_s = timed.start_s + (timed.steps + kFirstLift) * step_s;
}

Status PlanWalk(TimedPhase& timed, std::size_t i) {
  double total_m = 0.0;
  for (const PathPiece& piece : timed.phase.path) {
    if (!InRange(piece.length_m, 0.1, 1000.0)) {
      return Invalid(i, "a piece of the path must be 0.1 to 1000 m long, is " +
                            std::to_string(piece.length_m));
    }
    constexpr double kPeak = 1.875;  // steepest slope of the quick step
    if (!(std::abs(piece.turn_rad) * kPeak * kTightestBend_m <= piece.length_m)) {
      return Invalid(i, "a bend must not be tighter than 0.6 m: give " +
                            std::to_string(piece.turn_rad) + " rad more than " +
                            std::to_string(piece.length_m) + " m");
    }
    total_m += piece.length_m;
  }
  if (!(total_m >= 1.0)) {
    return Invalid(i, "a path must be at least 1 m long, is " + std::to_string(total_m));
  }
  timed.path = GroundPath(timed.from, timed.phase.path);
  timed.to = timed.path.end();
  const double wished_step_s = StepTime_s(timed.phase.speed_m_s);
  const double length_m = timed.path.length_m();
  timed.ramp_s = std::min(2.2 * wished_step_s, length_m / timed.phase.speed_m_s);
  PlanSteps(timed, length_m / timed.phase.speed_m_s + timed.ramp_s, wished_step_s);
  // The speed that fits a whole number of steps; the walk ends half a step before its last foot.
  timed.phase.speed_m_s = length_m / (timed.duration_s() - timed.ramp_s);
  timed.step_length_m = timed.phase.speed_m_s * timed.step_s;
  return Ok();
}

Status PlanPhase(TimedPhase& timed, std::size_t i) {
  switch (timed.phase.kind) {
    case PhaseKind::kWalk:
      return PlanWalk(timed, i);
    case PhaseKind::kTurn:
      timed.to.heading_rad += timed.phase.turn_rad;
      PlanSteps(timed, timed.phase.duration_s, StepTime_s(1.0));
      return Ok();
    case PhaseKind::kNPose:
    case PhaseKind::kStand:
    case PhaseKind::kSit:
      timed.end_s = timed.start_s + timed.phase.duration_s;
      return Ok();
  }
  return Ok();
}

TimedPhase LockPhase(const FloorPose& where, double start_s, bool unlocks) {
  TimedPhase timed;
  timed.phase.kind = PhaseKind::kNPose;
  timed.unlocks = unlocks;
  timed.locks = !unlocks;
  timed.start_s = start_s;
  timed.end_s = start_s + kLockTime_s;
  timed.from = timed.to = where;
  return timed;
}

bool SamePlace(const FloorPose& a, const FloorPose& b) {
  return std::hypot(a.x_m - b.x_m, a.y_m - b.y_m) < 1e-6 &&
         std::abs(std::remainder(a.heading_rad - b.heading_rad, 2.0 * kPi)) < 1e-6;
}

}  // namespace

Result<Timeline> Timeline::Make(const MotionSchedule& schedule, const FloorPose& start) {
  if (schedule.phases.empty() || schedule.repeat_from >= schedule.phases.size()) {
    return Error{ErrorCode::kInvalidArgument,
                 "a schedule needs phases, and repeat_from must be one of them"};
  }
  Timeline timeline;
  FloorPose where = start;
  double now_s = 0.0;
  bool upright = schedule.phases.front().kind == PhaseKind::kNPose;
  bool repeat_upright = upright;
  FloorPose repeat_place;
  for (std::size_t i = 0; i < schedule.phases.size(); ++i) {
    const Phase& phase = schedule.phases[i];
    if (const Status ok = ValidatePhase(phase, i); !ok) {
      return ok.error();
    }
    if (const bool wants_upright = phase.kind == PhaseKind::kNPose; wants_upright != upright) {
      timeline.phases_.push_back(LockPhase(where, now_s, upright));
      now_s = timeline.phases_.back().end_s;
      upright = wants_upright;
    }
    if (i == schedule.repeat_from) {
      timeline.repeat_from_s_ = now_s;
      repeat_place = where;
      repeat_upright = upright;
    }
    TimedPhase timed;
    timed.phase = phase;
    timed.start_s = now_s;
    timed.from = timed.to = where;
    if (const Status ok = PlanPhase(timed, i); !ok) {
      return ok.error();
    }
    if (const Status ok = ValidateGestures(timed, i); !ok) {
      return ok.error();
    }
    where = timed.to;
    now_s = timed.end_s;
    timeline.phases_.push_back(std::move(timed));
  }
  if (upright != repeat_upright) {
    timeline.phases_.push_back(LockPhase(where, now_s, upright));
  }
  if (!SamePlace(where, repeat_place)) {
    return Error{ErrorCode::kInvalidArgument,
                 "a schedule must end where phase repeat_from begins (it is " +
                     std::to_string(where.x_m - repeat_place.x_m) + " m, " +
                     std::to_string(where.y_m - repeat_place.y_m) + " m away)"};
  }
  return timeline;
}

Status Validate(const MotionSchedule& schedule) {
  const auto timeline = Timeline::Make(schedule);
  return timeline ? Ok() : Status(timeline.error());
}

Timeline::Place Timeline::At(double t_s) const {
  const double end_s = phases_.back().end_s;
  double local_s = std::max(0.0, t_s);
  if (local_s >= end_s) {
    local_s = repeat_from_s_ + std::fmod(local_s - repeat_from_s_, end_s - repeat_from_s_);
  }
  const auto found =
      std::upper_bound(phases_.begin(), phases_.end() - 1, local_s,
                       [](double s, const TimedPhase& phase) { return s < phase.end_s; });
  return {&*found, Jet::Variable(local_s - found->start_s)};
}

MovingFloorPose FloorPoseAt(const TimedPhase& phase, const Jet& since_s) {
  const FloorPose& from = phase.from;
  if (phase.phase.kind == PhaseKind::kTurn) {
    const Jet done =
        SmoothStep(since_s, kFirstLift * phase.step_s, phase.duration_s() - phase.step_s);
    return {from.x_m, from.y_m, from.heading_rad + phase.phase.turn_rad * done};
  }
  if (phase.phase.kind != PhaseKind::kWalk) {
    return {from.x_m, from.y_m, from.heading_rad};
  }
  // Gathers speed over ramp_s and loses it over the last ramp_s.
  const double ramp_s = phase.ramp_s;
  const double slowing_s = phase.duration_s() - ramp_s;
  const double rate = phase.phase.speed_m_s * ramp_s;
  const Jet u = rate * (SmoothStepIntegral(since_s * (1.0 / ramp_s)) -
                        SmoothStepIntegral((since_s - slowing_s) * (1.0 / ramp_s)));
  return phase.path.At(u);
}

MotionSchedule MakeStandingSchedule() {
  return {.phases = {{.kind = PhaseKind::kNPose, .duration_s = 60.0}}, .repeat_from = 0};
}

MotionSchedule MakeDefaultSchedule(double n_pose_s) {
  using enum GestureKind;
  const double pi = kPi;
  MotionSchedule schedule;
  schedule.repeat_from = 1;
  schedule.phases = {
      {.kind = PhaseKind::kNPose, .duration_s = n_pose_s},
      // A loop to the left, with a weave on both long sides.
      {.kind = PhaseKind::kWalk,
       .path =
           {{0.8}, {1.4, -0.5}, {1.4, 0.5}, {4.6, pi}, {0.8}, {1.4, -0.5}, {1.4, 0.5}, {4.6, pi}},
       .gestures = {{kLook, Side::kBoth, 3.0, 4.0},
                    {kWave, Side::kRight, 7.0, 4.0},
                    {kRaiseSide, Side::kLeft, 11.5, 3.0}}},
      {.kind = PhaseKind::kStand,
       .duration_s = 15.0,
       .gestures = {{kRaiseFront, Side::kBoth, 0.5, 3.0},
                    {kWindmill, Side::kLeft, 4.0, 3.0},
                    {kReach, Side::kRight, 4.5, 3.5},
                    {kTwist, Side::kBoth, 8.0, 3.5},
                    {kBow, Side::kBoth, 11.5, 3.0}}},
      {.kind = PhaseKind::kSit,
       .duration_s = 10.0,
       .gestures = {{kReach, Side::kBoth, 3.5, 3.0}, {kLook, Side::kBoth, 3.0, 4.0}}},
      {.kind = PhaseKind::kTurn, .duration_s = 4.0, .turn_rad = pi},
      // A loop to the right, which leaves home the other way.
      {.kind = PhaseKind::kWalk,
       .path = {{2.8}, {4.6, -pi}, {2.8}, {4.6, -pi}},
       .gestures = {{kRaiseFront, Side::kRight, 3.0, 3.0}, {kWindmill, Side::kLeft, 7.0, 3.0}}},
      {.kind = PhaseKind::kTurn, .duration_s = 4.0, .turn_rad = -pi},
      {.kind = PhaseKind::kStand, .duration_s = 2.0},
  };
  return schedule;
}

}  // namespace limbcast::simulation
