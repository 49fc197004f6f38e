#include "common/simulation/person_motion.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "common/simulation/leg_inverse.hpp"
#include "common/simulation/smooth_step.hpp"
#include "common/simulation/upper_body.hpp"

namespace limbcast::simulation {
namespace {

using body::Index;
using body::Segment;

constexpr double kDeg = std::numbers::pi / 180.0;
constexpr double kReadyKnee_rad = 10.0 * kDeg;  // relaxed standing
// When the hips pass the standing foot, in steps after the other one lifted.
constexpr double kHighest = 0.215;
constexpr double kSitTime_s = 2.2;

// Everything about one instant that the parts of the body share.
struct Moment {
  const TimedPhase& phase;
  Jet since_s;
  Jet t_s;
  GaitPhase gait;
  MovingFloorPose floor;
  Jet relaxed = 1.0;
  Jet standing_knee_rad = kReadyKnee_rad;
  bool knees_known = true;  // standing symmetrically: knee flexion is standing_knee_rad
};

Moment MakeMoment(const Timeline::Place& place, double t_s) {
  const TimedPhase& phase = *place.phase;
  Moment moment{phase, place.since_s, Jet::Variable(t_s), GaitPhaseAt(phase, place.since_s),
                FloorPoseAt(phase, place.since_s)};
  if (phase.phase.kind == PhaseKind::kNPose) {
    const Jet done = SmoothStep(place.since_s, 0.0, phase.duration_s());
    moment.relaxed = phase.unlocks ? done : phase.locks ? 1.0 - done : Jet{0.0};
    moment.standing_knee_rad = kReadyKnee_rad * moment.relaxed;
  }
  moment.knees_known = phase.steps == 0 && phase.phase.kind != PhaseKind::kSit;
  return moment;
}

// Amplitudes of pelvis motion: Perry, "Gait Analysis", chapter 8: rotation ±4°, obliquity ±4°,
// sway ±2 cm, rise and fall 4–5 cm.
RigidMotion Pelvis(const PersonShape& shape, const Moment& m) {
  Jet height_m =
      shape.ankle_height_m + HipToAnkle(m.standing_knee_rad, shape.upper_leg_m, shape.lower_leg_m);
  Jet forward_m;
  Jet left_m;
  Jet pitch_rad;
  Jet yaw_rad;
  Jet list_rad;
  if (m.phase.steps > 0) {
    // Low enough to reach the landing foot, and up again over the standing one.
    const double ready_m = height_m.value - shape.ankle_height_m;
    const double ahead_m = std::max(0.15, 0.486 * m.phase.step_length_m);
    const double low_m = ready_m - std::sqrt(ready_m * ready_m - ahead_m * ahead_m) + 0.002;
    const double rise_m = std::min(0.039, 0.8 * low_m);
    const Jet& amount = m.gait.amount;
    height_m -= amount * (low_m - 0.5 * rise_m * (1.0 + m.gait.EveryStep(kHighest)));
    left_m = 0.02 * amount * m.gait.Alternating(0.4);
    yaw_rad = 4.0 * kDeg * amount * m.gait.Alternating(0.85);
    list_rad = 3.5 * kDeg * amount * m.gait.Alternating(0.3);
    pitch_rad = amount * (2.0 * kDeg + 1.0 * kDeg * m.gait.EveryStep(0.1));
  }
  if (m.phase.phase.kind == PhaseKind::kSit) {
    const Jet seated = Window(m.since_s, 0.0, m.phase.duration_s(), kSitTime_s);
    const double seat_m = shape.ankle_height_m + shape.lower_leg_m;
    forward_m = -0.95 * shape.upper_leg_m * seated;
    height_m += (seat_m - height_m) * seated;
    pitch_rad = -8.0 * kDeg * seated +
                12.0 * kDeg *
                    (Bump(m.since_s * (1.0 / kSitTime_s)) +
                     Bump((m.since_s - (m.phase.duration_s() - kSitTime_s)) * (1.0 / kSitTime_s)));
  }
  const Jet c = Cos(m.floor.heading_rad);
  const Jet s = Sin(m.floor.heading_rad);
  RigidMotion pelvis = MovingPoint({m.floor.x_m + c * forward_m - s * left_m,
                                    m.floor.y_m + s * forward_m + c * left_m, height_m});
  RotateAbout(pelvis, 2, m.floor.heading_rad + yaw_rad);
  RotateAbout(pelvis, 1, pitch_rad);
  RotateAbout(pelvis, 0, list_rad);
  return pelvis;
}

RigidMotion Joint(const PersonShape& shape, const PersonPose& pose, Segment parent,
                  Segment segment) {
  return AtPoint(pose.segments[Index(parent)], shape.p_parent_segment_m[Index(segment)]);
}

void Leg(const PersonShape& shape, const FootMotion& foot, const Moment& m, Side side,
         PersonPose& pose) {
  const std::size_t shift = side == Side::kRight ? 0 : 4;
  const auto on_side = [shift](Segment right) {
    return static_cast<Segment>(Index(right) + shift);
  };
  const Segment upper = on_side(Segment::kRightUpperLeg);
  const Segment lower = on_side(Segment::kRightLowerLeg);
  const Segment ankle = on_side(Segment::kRightFoot);
  const Segment toe = on_side(Segment::kRightToe);

  RigidMotion hip = Joint(shape, pose, Segment::kPelvis, upper);
  const Jet3 reach_m = foot.p_earth_ankle_m - Origin(hip);
  const Jet distance_m = Sqrt(Dot(reach_m, reach_m));
  const Jet knee_rad = m.knees_known
                           ? m.standing_knee_rad
                           : KneeFlexion(distance_m, shape.upper_leg_m, shape.lower_leg_m);
  // The knee points between where the pelvis and where the foot faces.
  const Jet3 forward = Normalized({Cos(foot.heading_rad) + Cos(m.floor.heading_rad),
                                   Sin(foot.heading_rad) + Sin(m.floor.heading_rad), 0.0});
  const LegAxes axes = SolveLeg(Inverse(distance_m) * reach_m, forward, knee_rad, shape.upper_leg_m,
                                shape.lower_leg_m);
  SetAxes(hip, axes.upper_x, axes.hinge, axes.upper_z);
  pose.segments[Index(upper)] = hip;
  RigidMotion knee = Joint(shape, pose, upper, lower);
  SetAxes(knee, axes.lower_x, axes.hinge, axes.lower_z);
  pose.segments[Index(lower)] = knee;

  RigidMotion foot_frame = Joint(shape, pose, lower, ankle);
  foot_frame.R_earth_local.setIdentity();
  foot_frame.w_earth_local_rad_s.setZero();
  foot_frame.wd_earth_local_rad_s2.setZero();
  RotateAbout(foot_frame, 2, foot.heading_rad);
  RotateAbout(foot_frame, 1, foot.pitch_rad);
  pose.segments[Index(ankle)] = foot_frame;
  RigidMotion toe_frame = Joint(shape, pose, ankle, toe);
  RotateAbout(toe_frame, 1, foot.toe_pitch_rad - foot.pitch_rad);
  pose.segments[Index(toe)] = toe_frame;
  if (foot.contact) {
    pose.contacts |= 1U << Index(ankle);
  }
}

void Arm(const PersonShape& shape, const ArmAngles& angles, Side side, PersonPose& pose) {
  const double out = side == Side::kLeft ? 1.0 : -1.0;  // turns that are mirrored
  const std::size_t shift = side == Side::kRight ? 0 : 4;
  const auto on_side = [shift](Segment right) {
    return static_cast<Segment>(Index(right) + shift);
  };
  const Segment shoulder = on_side(Segment::kRightShoulder);
  const Segment upper = on_side(Segment::kRightUpperArm);
  const Segment fore = on_side(Segment::kRightForeArm);
  const Segment hand = on_side(Segment::kRightHand);

  RigidMotion frame = Joint(shape, pose, Segment::kT8, shoulder);
  RotateAbout(frame, 0, out * angles.shrug_rad);
  pose.segments[Index(shoulder)] = frame;
  frame = Joint(shape, pose, shoulder, upper);
  RotateAbout(frame, 1, -angles.flexion_rad);
  RotateAbout(frame, 0, out * angles.abduction_rad);
  RotateAbout(frame, 2, -out * angles.axial_rad);
  pose.segments[Index(upper)] = frame;
  frame = Joint(shape, pose, upper, fore);
  RotateAbout(frame, 1, -angles.elbow_rad);
  RotateAbout(frame, 2, -out * angles.pronation_rad);
  pose.segments[Index(fore)] = frame;
  frame = Joint(shape, pose, fore, hand);
  RotateAbout(frame, 0, -out * angles.wrist_rad);
  pose.segments[Index(hand)] = frame;
}

void TrunkAndHead(const PersonShape& shape, const UpperBodyAngles& angles, PersonPose& pose) {
  constexpr std::array<std::pair<Segment, Segment>, 4> kTrunk = {{
      {Segment::kPelvis, Segment::kL5},
      {Segment::kL5, Segment::kL3},
      {Segment::kL3, Segment::kT12},
      {Segment::kT12, Segment::kT8},
  }};
  for (const auto& [parent, segment] : kTrunk) {
    RigidMotion frame = Joint(shape, pose, parent, segment);
    RotateAbout(frame, 2, 0.25 * angles.trunk_yaw_rad);
    RotateAbout(frame, 1, 0.25 * angles.trunk_flex_rad);
    RotateAbout(frame, 0, 0.25 * angles.trunk_side_rad);
    pose.segments[Index(segment)] = frame;
  }
  for (const auto& [parent, segment] :
       {std::pair{Segment::kT8, Segment::kNeck}, std::pair{Segment::kNeck, Segment::kHead}}) {
    RigidMotion frame = Joint(shape, pose, parent, segment);
    RotateAbout(frame, 2, 0.5 * angles.head_yaw_rad);
    RotateAbout(frame, 1, 0.5 * angles.head_pitch_rad);
    pose.segments[Index(segment)] = frame;
  }
}

}  // namespace

Result<PersonMotion> PersonMotion::Make(const PersonShape& shape,
                                        const PersonMotionConfig& config) {
  auto timeline = Timeline::Make(config.schedule, config.start);
  if (!timeline) {
    return timeline.error();
  }
  return PersonMotion(shape, std::move(*timeline));
}

PersonMotion::PersonMotion(const PersonShape& shape, Timeline timeline)
    : shape_(shape), timeline_(std::move(timeline)) {
  footsteps_.reserve(timeline_.phases().size());
  for (const TimedPhase& phase : timeline_.phases()) {
    footsteps_.emplace_back(phase, shape_);
  }
}

PersonPose PersonMotion::At(double t_s) const {
  const Timeline::Place place = timeline_.At(t_s);
  const Moment moment = MakeMoment(place, t_s);
  const auto& footsteps =
      footsteps_[static_cast<std::size_t>(place.phase - timeline_.phases().data())];
  PersonPose pose;
  pose.segments[Index(Segment::kPelvis)] = Pelvis(shape_, moment);
  for (const Side side : {Side::kRight, Side::kLeft}) {
    Leg(shape_, footsteps.At(*place.phase, side, moment.since_s), moment, side, pose);
  }
  const UpperBodyAngles upper =
      UpperBodyAt(*place.phase, moment.since_s, moment.gait, moment.relaxed, moment.t_s);
  TrunkAndHead(shape_, upper, pose);
  Arm(shape_, upper.arms[0], Side::kRight, pose);
  Arm(shape_, upper.arms[1], Side::kLeft, pose);
  return pose;
}

}  // namespace limbcast::simulation
