#pragma once

#include <Eigen/Geometry>
#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string_view>

#include "common/body/segment.hpp"

namespace limbcast::body {

/// The joints whose angles are given. Numbers are part of the wire contract; left = right + 6.
enum class Joint : std::uint8_t {
  kPelvis = 0,  ///< pelvis in the earth frame
  kTrunk = 1,   ///< T8 about the pelvis
  kNeck = 2,    ///< head about T8
  kRightHip = 3,
  kRightKnee = 4,
  kRightAnkle = 5,
  kRightShoulder = 6,  ///< upper arm about T8, as ISB's thoracohumeral angles
  kRightElbow = 7,
  kRightWrist = 8,
  kLeftHip = 9,
  kLeftKnee = 10,
  kLeftAnkle = 11,
  kLeftShoulder = 12,
  kLeftElbow = 13,
  kLeftWrist = 14,
};
inline constexpr std::size_t kJointCount = 15;

[[nodiscard]] constexpr std::size_t Index(Joint joint) { return static_cast<std::size_t>(joint); }

/// Lower-snake name: "pelvis", "right_knee", ...
[[nodiscard]] std::string_view ToString(Joint joint);
[[nodiscard]] std::optional<Joint> ParseJoint(std::string_view name);

/// The two segments between which a joint turns; `parent` is empty for the pelvis (the earth).
struct JointSegments {
  std::optional<Segment> parent;
  Segment child = Segment::kPelvis;
};
[[nodiscard]] JointSegments SegmentsOf(Joint joint);

/// What the three angles of a joint are called, in the order of JointAngles::angle_rad.
[[nodiscard]] std::array<std::string_view, 3> AngleNames(Joint joint);

/// Three angles of one joint, in the order of its rotations.
struct JointAngles {
  Eigen::Vector3d angle_rad = Eigen::Vector3d::Zero();
  /// Within kNearSingular_rad of the singularity of the joint's sequence: the first and the third
  /// angle turn about nearly the same axis there, and noise moves much from one to the other. Only
  /// their sum (shoulder: at the hanging arm) still means something.
  bool near_singular = false;
};
inline constexpr double kNearSingular_rad = 0.175;  // 10°: noise is amplified 1/sin 10° = 5.8 times

/// Joint angles after the recommendations of the ISB: Wu et al. 2002, J. Biomech. 35:543–548 (hip,
/// ankle, spine; the knee after Grood & Suntay 1983, J. Biomech. Eng. 105:136–144) and Wu et al.
/// 2005, J. Biomech. 38:981–992 (shoulder, elbow, wrist, thorax). Segment axes are those of the
/// house, x forward, y left, z up; they are read as ISB's (forward, up, right) = (x, z, −y). All
/// angles are zero in the N-pose, and the left side is mirrored, so that a sign means the same on
/// both sides.
///
/// | joint             | sequence  | first: positive   | second: positive    | third: positive    |
/// |-------------------|-----------|-------------------|---------------------|--------------------|
/// | hip, knee         | z-x'-y''  | flexion           | adduction           | internal rotation  |
/// | ankle             | z-x'-y''  | dorsiflexion      | inversion           | internal rotation  |
/// | trunk, neck       | z-x'-y''  | flexion (forward) | bending to the right | rotation to the
/// left | | shoulder          | y-x'-y''  | plane of elevation: 0 sideways, π/2 forward |
/// elevation, 0 to π | internal rotation | | elbow             | z-x'-y''  | flexion           |
/// carrying (outwards) | pronation          | | wrist             | z-x'-y''  | palmar flexion    |
/// ulnar deviation     | pronation          | | pelvis (in earth) | y-x'-z''  | rotation to the
/// left (heading) | right side down | forward tilt |
///
/// The first and third angle are in (−π, π], the second in [−π/2, π/2], of the shoulder in [0, π].
/// Where we differ from the papers: flexion of knee, trunk and neck and elevation are positive
/// (there negative) and so is the carrying angle; pronation counts from the palm turned inwards, as
/// the N-pose has it, which is π/2 of ISB's count from the palm forward; the pelvis is taken apart
/// about the vertical first (Baker 2001, Gait & Posture 13:1–6), so that tilt and obliquity do not
/// depend on which way the person faces.
///
/// At a singularity itself the joint's first angle (shoulder: the plane of elevation) is 0.
///
/// @param q_earth_parent  identity for the pelvis, whose parent is the earth.
[[nodiscard]] JointAngles AnglesOf(Joint joint, const Eigen::Quaterniond& q_earth_parent,
                                   const Eigen::Quaterniond& q_earth_child);

/// The inverse: orientation of the child in its parent with these angles, q_parent_child.
[[nodiscard]] Eigen::Quaterniond RotationOf(Joint joint, const Eigen::Vector3d& angle_rad);

/// All joints of a person at once, by Index(joint).
[[nodiscard]] std::array<JointAngles, kJointCount> AllJointAngles(
    const std::array<Eigen::Quaterniond, kSegmentCount>& q_earth_segment);

}  // namespace limbcast::body
