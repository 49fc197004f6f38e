#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string_view>

namespace limbcast::body {

/// The 23 segments of the field's common full-body model, in its order (field.md 3.3). Numbers are
/// part of the wire contract.
enum class Segment : std::uint8_t {
  kPelvis = 0,
  kL5 = 1,
  kL3 = 2,
  kT12 = 3,
  kT8 = 4,
  kNeck = 5,
  kHead = 6,
  kRightShoulder = 7,
  kRightUpperArm = 8,
  kRightForeArm = 9,
  kRightHand = 10,
  kLeftShoulder = 11,
  kLeftUpperArm = 12,
  kLeftForeArm = 13,
  kLeftHand = 14,
  kRightUpperLeg = 15,
  kRightLowerLeg = 16,
  kRightFoot = 17,
  kRightToe = 18,
  kLeftUpperLeg = 19,
  kLeftLowerLeg = 20,
  kLeftFoot = 21,
  kLeftToe = 22,
};
inline constexpr std::size_t kSegmentCount = 23;

[[nodiscard]] constexpr std::size_t Index(Segment segment) {
  return static_cast<std::size_t>(segment);
}

/// Lower-snake name used in configuration, recordings and screens: "pelvis", "right_upper_arm", ...
[[nodiscard]] std::string_view ToString(Segment segment);

/// The segment of a name as ToString writes it; nothing when there is none.
[[nodiscard]] std::optional<Segment> ParseSegment(std::string_view name);

/// The parent towards the pelvis; nothing for the pelvis.
[[nodiscard]] std::optional<Segment> ParentOf(Segment segment);

/// Pelvis to head.
[[nodiscard]] constexpr bool IsTrunk(Segment segment) { return segment <= Segment::kHead; }
[[nodiscard]] constexpr bool IsLeg(Segment segment) { return segment >= Segment::kRightUpperLeg; }
/// Upper arm to hand: shoulders go with the trunk, but are none of it.
[[nodiscard]] constexpr bool IsArm(Segment segment) {
  return !IsTrunk(segment) && !IsLeg(segment) && segment != Segment::kRightShoulder &&
         segment != Segment::kLeftShoulder;
}

/// All segments, every parent before its children.
[[nodiscard]] const std::array<Segment, kSegmentCount>& AllSegments();

}  // namespace limbcast::body
