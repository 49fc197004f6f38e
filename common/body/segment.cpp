#include "common/body/segment.hpp"

namespace limbcast::body {
namespace {

struct Row {
  Segment segment;
  std::string_view name;
  std::optional<Segment> parent;
};

// Parents follow the joints of field.md 3.3: a trunk chain, arms from T8, legs from the pelvis.
constexpr std::array<Row, kSegmentCount> kRows = {{
    {Segment::kPelvis, "pelvis", std::nullopt},
    {Segment::kL5, "l5", Segment::kPelvis},
    {Segment::kL3, "l3", Segment::kL5},
    {Segment::kT12, "t12", Segment::kL3},
    {Segment::kT8, "t8", Segment::kT12},
    {Segment::kNeck, "neck", Segment::kT8},
    {Segment::kHead, "head", Segment::kNeck},
    {Segment::kRightShoulder, "right_shoulder", Segment::kT8},
    {Segment::kRightUpperArm, "right_upper_arm", Segment::kRightShoulder},
    {Segment::kRightForeArm, "right_fore_arm", Segment::kRightUpperArm},
    {Segment::kRightHand, "right_hand", Segment::kRightForeArm},
    {Segment::kLeftShoulder, "left_shoulder", Segment::kT8},
    {Segment::kLeftUpperArm, "left_upper_arm", Segment::kLeftShoulder},
    {Segment::kLeftForeArm, "left_fore_arm", Segment::kLeftUpperArm},
    {Segment::kLeftHand, "left_hand", Segment::kLeftForeArm},
    {Segment::kRightUpperLeg, "right_upper_leg", Segment::kPelvis},
    {Segment::kRightLowerLeg, "right_lower_leg", Segment::kRightUpperLeg},
    {Segment::kRightFoot, "right_foot", Segment::kRightLowerLeg},
    {Segment::kRightToe, "right_toe", Segment::kRightFoot},
    {Segment::kLeftUpperLeg, "left_upper_leg", Segment::kPelvis},
    {Segment::kLeftLowerLeg, "left_lower_leg", Segment::kLeftUpperLeg},
    {Segment::kLeftFoot, "left_foot", Segment::kLeftLowerLeg},
    {Segment::kLeftToe, "left_toe", Segment::kLeftFoot},
}};

}  // namespace

std::string_view ToString(Segment segment) {
  const std::size_t index = Index(segment);
  return index < kRows.size() ? kRows[index].name : "unknown";
}

std::optional<Segment> ParseSegment(std::string_view name) {
  for (const Row& row : kRows) {
    if (row.name == name) {
      return row.segment;
    }
  }
  return std::nullopt;
}

std::optional<Segment> ParentOf(Segment segment) {
  const std::size_t index = Index(segment);
  return index < kRows.size() ? kRows[index].parent : std::nullopt;
}

const std::array<Segment, kSegmentCount>& AllSegments() {
  static constexpr auto kAll = [] {
    std::array<Segment, kSegmentCount> all{};
    for (std::size_t i = 0; i < kSegmentCount; ++i) {
      all[i] = kRows[i].segment;
    }
    return all;
  }();
  return kAll;
}

}  // namespace limbcast::body
