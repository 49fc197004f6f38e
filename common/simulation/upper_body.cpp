#include "common/simulation/upper_body.hpp"

#include <algorithm>
#include <numbers>

#include "common/simulation/smooth_step.hpp"

namespace limbcast::simulation {
namespace {

constexpr double kTwoPi = 2.0 * std::numbers::pi;
constexpr double kDeg = std::numbers::pi / 180.0;

// Small, slow, never repeating: two sines of incommensurate frequencies.
Jet Sway(const Jet& t_s, double hz, double phase) {
  return 0.6 * Sin(kTwoPi * hz * t_s + phase) + 0.4 * Sin(kTwoPi * 1.618 * hz * t_s + 2.0 * phase);
}

UpperBodyAngles Relaxed(const Jet& relaxed, const Jet& t_s) {
  UpperBodyAngles body;
  body.trunk_yaw_rad = relaxed * (1.5 * kDeg * Sway(t_s, 0.11, 0.3));
  body.trunk_side_rad = relaxed * (1.0 * kDeg * Sway(t_s, 0.17, 1.1));
  body.trunk_flex_rad = relaxed * (2.0 * kDeg + 0.7 * kDeg * Sway(t_s, 0.23, 2.0));
  body.head_yaw_rad = relaxed * (5.0 * kDeg * Sway(t_s, 0.13, 0.9));
  body.head_pitch_rad = relaxed * (3.0 * kDeg * Sway(t_s, 0.19, 1.7));
  for (std::size_t i = 0; i < body.arms.size(); ++i) {
    ArmAngles& arm = body.arms[i];
    const double phase = 1.3 * static_cast<double>(i);
    arm.flexion_rad = relaxed * (2.0 * kDeg * Sway(t_s, 0.21, phase));
    arm.abduction_rad = relaxed * (7.0 * kDeg + 1.0 * kDeg * Sway(t_s, 0.16, phase + 0.5));
    arm.axial_rad = relaxed * (8.0 * kDeg);
    arm.elbow_rad = relaxed * (14.0 * kDeg + 2.0 * kDeg * Sway(t_s, 0.27, phase + 0.8));
    arm.pronation_rad = relaxed * (15.0 * kDeg);
    arm.wrist_rad = relaxed * (5.0 * kDeg);
  }
  return body;
}

// Amplitudes of comfortable walking: shoulder ±17°, elbow 10–30°, shoulders against pelvis
// (Murray 1967, "Gait as a total pattern of movement", Am. J. Phys. Med. 46).
void AddGait(const GaitPhase& gait, UpperBodyAngles& body) {
  const Jet right_landing = gait.amount * gait.Alternating(0.85);
  body.trunk_yaw_rad -= 8.0 * kDeg * right_landing;
  body.head_yaw_rad += 3.5 * kDeg * right_landing;
  body.trunk_flex_rad += gait.amount * (3.0 * kDeg + 1.5 * kDeg * gait.EveryStep(0.0));
  body.trunk_side_rad -= 3.0 * kDeg * gait.amount * gait.Alternating(0.3);
  body.head_pitch_rad += gait.amount * (-3.0 * kDeg + 1.5 * kDeg * gait.EveryStep(0.6));
  for (std::size_t i = 0; i < body.arms.size(); ++i) {
    ArmAngles& arm = body.arms[i];
    const Jet forward = i == 0 ? -right_landing : right_landing;  // left arm with the right leg
    arm.flexion_rad += 17.0 * kDeg * forward + 3.0 * kDeg * gait.amount;
    arm.elbow_rad += 9.0 * kDeg * (forward + gait.amount);
    arm.axial_rad += 5.0 * kDeg * forward;
    arm.wrist_rad += 4.0 * kDeg * gait.amount * gait.EveryStep(0.2);
  }
}

void AddArm(const Gesture& gesture, const Jet& time_s, const Jet& on, ArmAngles& arm) {
  const auto wiggle = [&](double hz) { return Sin(kTwoPi * hz * (time_s - gesture.start_s)); };
  switch (gesture.kind) {
    case GestureKind::kRaiseFront:
      arm.flexion_rad += 150.0 * kDeg * on;
      arm.shrug_rad += 12.0 * kDeg * on;
      arm.pronation_rad += 30.0 * kDeg * on;
      break;
    case GestureKind::kRaiseSide:
      arm.abduction_rad += 123.0 * kDeg * on;
      arm.axial_rad -= 60.0 * kDeg * on;
      arm.shrug_rad += 15.0 * kDeg * on;
      break;
    case GestureKind::kWave:
      arm.abduction_rad += 70.0 * kDeg * on;
      arm.axial_rad -= (95.0 * kDeg + 25.0 * kDeg * wiggle(1.3)) * on;
      arm.elbow_rad += 85.0 * kDeg * on;
      arm.wrist_rad += 15.0 * kDeg * wiggle(1.3) * on;
      break;
    case GestureKind::kWindmill:
      arm.flexion_rad +=
          kTwoPi * SmoothStep(time_s, gesture.start_s, gesture.start_s + gesture.duration_s);
      arm.abduction_rad += 12.0 * kDeg * on;
      break;
    case GestureKind::kReach:
      arm.flexion_rad += (70.0 * kDeg + 10.0 * kDeg * wiggle(0.8)) * on;
      arm.elbow_rad += (45.0 * kDeg + 35.0 * kDeg * wiggle(0.8)) * on;
      arm.pronation_rad += 50.0 * kDeg * wiggle(0.55) * on;
      arm.wrist_rad += 20.0 * kDeg * wiggle(0.9) * on;
      break;
    case GestureKind::kTwist:
      arm.abduction_rad += 20.0 * kDeg * on;
      break;
    case GestureKind::kBow:
      arm.flexion_rad += 35.0 * kDeg * on;
      break;
    case GestureKind::kLook:
      break;
  }
}

void AddGesture(const Gesture& gesture, const Jet& time_s, UpperBodyAngles& body) {
  const double end_s = gesture.start_s + gesture.duration_s;
  if (time_s.value <= gesture.start_s || time_s.value >= end_s) {
    return;
  }
  const double ramp_s = std::min(1.2, 0.45 * gesture.duration_s);
  const Jet on = Window(time_s, gesture.start_s, end_s, ramp_s);
  const Jet once = Sin(kTwoPi * (time_s - gesture.start_s) * (1.0 / gesture.duration_s));
  if (gesture.kind == GestureKind::kTwist) {
    body.trunk_yaw_rad += 35.0 * kDeg * once * on;
    body.head_yaw_rad += 15.0 * kDeg * once * on;
  } else if (gesture.kind == GestureKind::kBow) {
    body.trunk_flex_rad += 50.0 * kDeg * on;
    body.head_pitch_rad += 15.0 * kDeg * on;
  } else if (gesture.kind == GestureKind::kLook) {
    body.head_yaw_rad += 45.0 * kDeg * once * on;
    body.head_pitch_rad += 15.0 * kDeg * once * once * on;
  }
  for (const Side side : {Side::kRight, Side::kLeft}) {
    if (gesture.side == side || gesture.side == Side::kBoth) {
      AddArm(gesture, time_s, on, body.arms[static_cast<std::size_t>(side)]);
    }
  }
}

// Leaning forward brings the weight over the feet while sitting down and getting up.
void AddSitting(const TimedPhase& phase, const Jet& since_s, UpperBodyAngles& body) {
  const double end_s = phase.duration_s();
  const Jet lean = Bump(since_s * (1.0 / 2.2)) + Bump((since_s - (end_s - 2.2)) * (1.0 / 2.2));
  body.trunk_flex_rad += 30.0 * kDeg * lean;
  body.head_pitch_rad -= 15.0 * kDeg * lean;
  const Jet seated = Window(since_s, 0.0, end_s, 2.2);
  for (ArmAngles& arm : body.arms) {
    arm.flexion_rad += 15.0 * kDeg * seated;
    arm.elbow_rad += 45.0 * kDeg * seated;
    arm.pronation_rad += 30.0 * kDeg * seated;
  }
}

}  // namespace

UpperBodyAngles UpperBodyAt(const TimedPhase& phase, const Jet& since_s, const GaitPhase& gait,
                            const Jet& relaxed, const Jet& t_s) {
  UpperBodyAngles body = Relaxed(relaxed, t_s);
  if (phase.steps > 0) {
    AddGait(gait, body);
  }
  if (phase.phase.kind == PhaseKind::kSit) {
    AddSitting(phase, since_s, body);
  }
  for (const Gesture& gesture : phase.phase.gestures) {
    AddGesture(gesture, since_s, body);
  }
  return body;
}

}  // namespace limbcast::simulation
