#include "common/body/joint_angles.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "common/base/expects.hpp"

// Notation: E earth, P parent, C child; letters of ISB: R = R_PC in axes X forward, Y up, Z right;
// a, b, c the angles of the first, second and third rotation.

namespace limbcast::body {
namespace {

constexpr double kHalfPi = std::numbers::pi / 2.0;

enum class Sequence : std::uint8_t {
  kZxy,      // R = Rz(a)·Rx(b)·Ry(c), Grood & Suntay 1983; Wu 2002, Wu 2005
  kYxy,      // R = Ry(a)·Rx(−b)·Ry(c), Wu 2005, section 2.4.7
  kYxz,      // R = Ry(a)·Rx(b)·Rz(c), Baker 2001
  kZxyPalm,  // as kZxy in axes whose X is where the palm looks: in the N-pose, to the body
};

struct Row {
  std::string_view name;
  std::optional<Segment> parent;
  Segment child;
  Sequence sequence;
  std::array<int, 3> sign;  // of our angle against the sequence's
  bool left;
  std::array<std::string_view, 3> angles;
};

using Names = std::array<std::string_view, 3>;
constexpr Names kLeg = {"flexion", "adduction", "internal_rotation"};
constexpr Names kAnkle = {"dorsiflexion", "inversion", "internal_rotation"};
constexpr Names kSpine = {"flexion", "right_bending", "left_rotation"};
constexpr Names kArm = {"elevation_plane", "elevation", "internal_rotation"};
constexpr Names kElbow = {"flexion", "carrying", "pronation"};
constexpr Names kWrist = {"flexion", "ulnar_deviation", "pronation"};
constexpr Names kInEarth = {"left_rotation", "right_obliquity", "forward_tilt"};

using enum Segment;
constexpr std::array<Row, kJointCount> kRows = {{
    {"pelvis", std::nullopt, kPelvis, Sequence::kYxz, {1, 1, -1}, false, kInEarth},
    {"trunk", kPelvis, kT8, Sequence::kZxy, {-1, 1, 1}, false, kSpine},
    {"neck", kT8, kHead, Sequence::kZxy, {-1, 1, 1}, false, kSpine},
    {"right_hip", kPelvis, kRightUpperLeg, Sequence::kZxy, {1, 1, 1}, false, kLeg},
    {"right_knee", kRightUpperLeg, kRightLowerLeg, Sequence::kZxy, {-1, 1, 1}, false, kLeg},
    {"right_ankle", kRightLowerLeg, kRightFoot, Sequence::kZxy, {1, 1, 1}, false, kAnkle},
    {"right_shoulder", kT8, kRightUpperArm, Sequence::kYxy, {1, 1, 1}, false, kArm},
    {"right_elbow", kRightUpperArm, kRightForeArm, Sequence::kZxy, {1, -1, 1}, false, kElbow},
    {"right_wrist", kRightForeArm, kRightHand, Sequence::kZxyPalm, {1, 1, 1}, false, kWrist},
    {"left_hip", kPelvis, kLeftUpperLeg, Sequence::kZxy, {1, 1, 1}, true, kLeg},
    {"left_knee", kLeftUpperLeg, kLeftLowerLeg, Sequence::kZxy, {-1, 1, 1}, true, kLeg},
    {"left_ankle", kLeftLowerLeg, kLeftFoot, Sequence::kZxy, {1, 1, 1}, true, kAnkle},
    {"left_shoulder", kT8, kLeftUpperArm, Sequence::kYxy, {1, 1, 1}, true, kArm},
    {"left_elbow", kLeftUpperArm, kLeftForeArm, Sequence::kZxy, {1, -1, 1}, true, kElbow},
    {"left_wrist", kLeftForeArm, kLeftHand, Sequence::kZxyPalm, {1, 1, 1}, true, kWrist},
}};

const Row& RowOf(Joint joint) {
  Expects(Index(joint) < kJointCount, "a known joint");
  return kRows[Index(joint)];
}

// House axes to ISB's, (x, z, −y); of a left joint its mirror image in the sagittal plane, which
// turns the rotation vector (X, Y, Z) into (−X, −Y, Z).
Eigen::Quaterniond ToIsb(const Eigen::Quaterniond& q, bool left) {
  const double side = left ? -1.0 : 1.0;
  return {q.w(), side * q.x(), side * q.z(), -q.y()};
}

Eigen::Quaterniond FromIsb(const Eigen::Quaterniond& q, bool left) {
  const double side = left ? -1.0 : 1.0;
  return {q.w(), side * q.x(), -q.z(), side * q.y()};
}

Eigen::Quaterniond About(int axis, double angle_rad) {
  return Eigen::Quaterniond(Eigen::AngleAxisd(angle_rad, Eigen::Vector3d::Unit(axis)));
}

// In the N-pose the palm of the right hand looks to the left, −Z: X turned by π/2 about Y.
Eigen::Quaterniond PalmAxes() { return About(1, kHalfPi); }

// Below this the sine that both angles hang on is rounding, and two of the angles are one.
constexpr double kSingularSine = 1e-9;

// The third angle is read after the first was undone, so that near a singularity, where the first
// is uncertain, both together are right.
Eigen::Vector3d Zxy(const Eigen::Matrix3d& R) {
  const double cos_b = std::hypot(R(0, 1), R(1, 1));
  const double a = cos_b < kSingularSine ? 0.0 : std::atan2(-R(0, 1), R(1, 1));
  // First row of Rz(−a)·R = Rx(b)·Ry(c): (cos c, 0, sin c).
  const Eigen::RowVector3d row = std::cos(a) * R.row(0) + std::sin(a) * R.row(1);
  return {a, std::atan2(R(2, 1), cos_b), std::atan2(row[2], row[0])};
}

Eigen::Vector3d Yxy(const Eigen::Matrix3d& R) {
  const double sin_b = std::hypot(R(0, 1), R(2, 1));
  const double a = sin_b < kSingularSine ? 0.0 : std::atan2(-R(0, 1), -R(2, 1));
  // First row of Ry(−a)·R = Rx(−b)·Ry(c): (cos c, 0, sin c).
  const Eigen::RowVector3d row = std::cos(a) * R.row(0) - std::sin(a) * R.row(2);
  return {a, std::atan2(sin_b, R(1, 1)), std::atan2(row[2], row[0])};
}

Eigen::Vector3d Yxz(const Eigen::Matrix3d& R) {
  const double cos_b = std::hypot(R(0, 2), R(2, 2));
  const double a = cos_b < kSingularSine ? 0.0 : std::atan2(R(0, 2), R(2, 2));
  // First row of Ry(−a)·R = Rx(b)·Rz(c): (cos c, −sin c, 0).
  const Eigen::RowVector3d row = std::cos(a) * R.row(0) - std::sin(a) * R.row(2);
  return {a, std::atan2(-R(1, 2), cos_b), std::atan2(-row[1], row[0])};
}

double FromSingularity_rad(Sequence sequence, double b) {
  return sequence == Sequence::kYxy ? std::min(b, std::numbers::pi - b) : kHalfPi - std::abs(b);
}

}  // namespace

std::string_view ToString(Joint joint) {
  return Index(joint) < kJointCount ? kRows[Index(joint)].name : "unknown";
}

std::optional<Joint> ParseJoint(std::string_view name) {
  for (std::size_t i = 0; i < kJointCount; ++i) {
    if (kRows[i].name == name) {
      return static_cast<Joint>(i);
    }
  }
  return std::nullopt;
}

JointSegments SegmentsOf(Joint joint) { return {RowOf(joint).parent, RowOf(joint).child}; }

std::array<std::string_view, 3> AngleNames(Joint joint) { return RowOf(joint).angles; }

JointAngles AnglesOf(Joint joint, const Eigen::Quaterniond& q_EP, const Eigen::Quaterniond& q_EC) {
  const Row& row = RowOf(joint);
  Eigen::Quaterniond q_PC = ToIsb(q_EP.conjugate() * q_EC, row.left);
  if (row.sequence == Sequence::kZxyPalm) {
    q_PC = PalmAxes().conjugate() * q_PC * PalmAxes();
  }
  const Eigen::Matrix3d R = q_PC.toRotationMatrix();
  Eigen::Vector3d abc;
  switch (row.sequence) {
    case Sequence::kZxy:
    case Sequence::kZxyPalm:
      abc = Zxy(R);
      break;
    case Sequence::kYxy:
      abc = Yxy(R);
      break;
    case Sequence::kYxz:
      abc = Yxz(R);
      break;
  }
  JointAngles angles;
  angles.near_singular = FromSingularity_rad(row.sequence, abc[1]) < kNearSingular_rad;
  for (Eigen::Index i = 0; i < 3; ++i) {
    angles.angle_rad[i] = row.sign[static_cast<std::size_t>(i)] * abc[i];
  }
  return angles;
}

Eigen::Quaterniond RotationOf(Joint joint, const Eigen::Vector3d& angle_rad) {
  const Row& row = RowOf(joint);
  const double a = row.sign[0] * angle_rad[0];
  const double b = row.sign[1] * angle_rad[1];
  const double c = row.sign[2] * angle_rad[2];
  switch (row.sequence) {
    case Sequence::kZxy:
      return FromIsb(About(2, a) * About(0, b) * About(1, c), row.left);
    case Sequence::kZxyPalm:
      return FromIsb(PalmAxes() * About(2, a) * About(0, b) * About(1, c) * PalmAxes().conjugate(),
                     row.left);
    case Sequence::kYxy:
      return FromIsb(About(1, a) * About(0, -b) * About(1, c), row.left);
    case Sequence::kYxz:
      break;
  }
  return FromIsb(About(1, a) * About(0, b) * About(2, c), row.left);
}

std::array<JointAngles, kJointCount> AllJointAngles(
    const std::array<Eigen::Quaterniond, kSegmentCount>& q_earth_segment) {
  std::array<JointAngles, kJointCount> all;
  for (std::size_t i = 0; i < kJointCount; ++i) {
    const Row& row = kRows[i];
    all[i] = AnglesOf(static_cast<Joint>(i),
                      row.parent ? q_earth_segment[Index(*row.parent)]
                                 : Eigen::Quaterniond(Eigen::Quaterniond::Identity()),
                      q_earth_segment[Index(row.child)]);
  }
  return all;
}

}  // namespace limbcast::body
