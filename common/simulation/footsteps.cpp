#include "common/simulation/footsteps.hpp"

#include <algorithm>
#include <cmath>

#include "common/math/angles.hpp"
#include "common/simulation/gait_phase.hpp"
#include "common/simulation/smooth_step.hpp"

namespace limbcast::simulation {
namespace {

// Times in steps after the foot lifts (negative: before). Order and size follow Perry, "Gait
// Analysis", chapter 4; the numbers were searched so that the knee angle of a stride is as people
// walk (60° in swing, no more than 25° while loaded) and no leg is ever overstretched.
constexpr double kHeelRises = -0.59;
constexpr double kPitchPeak = 0.17;
constexpr double kPitchLevel = 0.68;
constexpr double kToesUp = 0.41;
constexpr double kFlat = 1.0;
constexpr double kBetween = 1.3;  // flat: the heel may hand over to the toe joint unseen

constexpr double kPlacementLead = 0.465;
constexpr double kHeelRise_rad = 1.135;
constexpr double kHeelStrike_rad = 0.288;
constexpr double kClearance_m = 0.1;
constexpr double kFullStride_m = 1.1;
constexpr double kWalkHalfWidth = 0.65;  // of the hips' half width

double SideSign(Side side) { return side == Side::kRight ? -1.0 : 1.0; }

}  // namespace

Footsteps::Placement Footsteps::Standing(const FloorPose& where, Side side) const {
  const FloorPose foot = Compose(where, FloorPose{0.0, SideSign(side) * shape_.hip_half_m, 0.0});
  return {foot.x_m, foot.y_m, foot.heading_rad, 0.0};
}

Footsteps::Footsteps(const TimedPhase& phase, const PersonShape& shape) : shape_(shape) {
  placements_ = {Standing(phase.from, Side::kRight), Standing(phase.from, Side::kLeft)};
  for (int k = 0; k < phase.steps; ++k) {
    const Side side = k % 2 == 0 ? Side::kRight : Side::kLeft;
    Placement next = Standing(phase.to, side);
    if (k + 2 < phase.steps) {
      const double at_s = (kFirstLift + k + kSwing + kPlacementLead) * phase.step_s;
      const MovingFloorPose ahead = FloorPoseAt(phase, Jet{std::min(at_s, phase.duration_s())});
      const double width = phase.phase.kind == PhaseKind::kWalk ? kWalkHalfWidth : 1.0;
      const FloorPose foot =
          Compose(FloorPose{ahead.x_m.value, ahead.y_m.value, ahead.heading_rad.value},
                  FloorPose{0.0, width * SideSign(side) * shape_.hip_half_m, 0.0});
      next = {foot.x_m, foot.y_m, foot.heading_rad, 0.0};
    }
    const Placement& last = placements_[static_cast<std::size_t>(k)];
    const double stride_m = std::hypot(next.x_m - last.x_m, next.y_m - last.y_m);
    next.roll = std::clamp(stride_m / kFullStride_m, 0.25, 1.0);
    placements_.push_back(next);
  }
}

FootMotion Footsteps::At(const TimedPhase& phase, Side side, const Jet& since_s) const {
  const int parity = side == Side::kRight ? 0 : 1;
  Placement stands = placements_[static_cast<std::size_t>(parity)];
  if (phase.steps > 0) {
    const Jet steps = since_s * (1.0 / phase.step_s) - kFirstLift;
    // The step of this foot whose stretch from flat to flat holds this instant.
    const int k =
        parity + 2 * static_cast<int>(std::floor((steps.value - parity + (2.0 - kBetween)) / 2.0));
    if (k >= 0 && k < phase.steps) {
      return Swinging(placements_[static_cast<std::size_t>(k)],
                      placements_[static_cast<std::size_t>(k) + 2], steps - k);
    }
    if (k >= phase.steps) {
      const int last = phase.steps - 1 - ((phase.steps - 1 - parity) % 2 == 0 ? 0 : 1);
      stands = placements_[static_cast<std::size_t>(last) + 2];
    }
  }
  FootMotion foot;
  foot.p_earth_ankle_m = {stands.x_m, stands.y_m, shape_.ankle_height_m};
  foot.heading_rad = stands.heading_rad;
  foot.contact = true;
  return foot;
}

FootMotion Footsteps::Swinging(const Placement& from, const Placement& to,
                               const Jet& steps_since_lift) const {
  const Jet& s = steps_since_lift;
  FootMotion foot;
  foot.contact = s.value <= 0.0 || s.value >= kSwing;
  foot.pitch_rad = to.roll * (kHeelRise_rad * (SmoothStep(s, kHeelRises, kPitchPeak) -
                                               SmoothStep(s, kPitchPeak, kPitchLevel)) -
                              kHeelStrike_rad * (SmoothStep(s, kToesUp, kSwing - 0.02) -
                                                 SmoothStep(s, kSwing - 0.02, kFlat)));
  foot.toe_pitch_rad = foot.pitch_rad * SmoothStep(s, 0.25, 0.8);

  // The point that rests: the toe joint before the swing, the heel after it; during the swing the
  // one turns into the other while it travels. z of the toe joint is its height over the sole.
  const Jet swing = s * (1.0 / kSwing);
  const Jet done = QuickStep(swing);
  const double ball_m = shape_.ball_forward_m;
  const double heel_m = -shape_.heel_back_m;
  const Jet pivot_x_m = ball_m + (heel_m - ball_m) * done;
  const Jet pivot_over_sole_m = shape_.ball_height_m * (1.0 - done);

  const double turn_rad = math::WrappedAngle_rad(to.heading_rad - from.heading_rad);
  foot.heading_rad = from.heading_rad + turn_rad * done;
  const auto on_floor = [](const Placement& at, double forward_m) {
    return std::pair{at.x_m + forward_m * std::cos(at.heading_rad),
                     at.y_m + forward_m * std::sin(at.heading_rad)};
  };
  const auto [ball_x_m, ball_y_m] = on_floor(from, ball_m);
  const auto [heel_x_m, heel_y_m] = on_floor(to, heel_m);
  const Jet3 pivot_m = {ball_x_m + (heel_x_m - ball_x_m) * done,
                        ball_y_m + (heel_y_m - ball_y_m) * done,
                        pivot_over_sole_m + kClearance_m * EarlyBump(swing)};

  // Ankle from the pivot, in the foot's axes, turned by pitch (about y) and heading (about z).
  const Jet x_m = -pivot_x_m;
  const Jet z_m = shape_.ankle_height_m - pivot_over_sole_m;
  const Jet c = Cos(foot.pitch_rad);
  const Jet n = Sin(foot.pitch_rad);
  const Jet forward_m = c * x_m + n * z_m;
  foot.p_earth_ankle_m = pivot_m + Jet3{Cos(foot.heading_rad) * forward_m,
                                        Sin(foot.heading_rad) * forward_m, c * z_m - n * x_m};
  return foot;
}

}  // namespace limbcast::simulation
