#include "common/body/sensor_place.hpp"

namespace limbcast::body {
namespace {

bool IsRight(Segment segment) {
  return (segment >= Segment::kRightShoulder && segment <= Segment::kRightHand) ||
         (segment >= Segment::kRightUpperLeg && segment <= Segment::kRightToe);
}

Eigen::Vector3d LeftSkin_m(Segment left) {
  switch (left) {
    case Segment::kLeftUpperArm:
    case Segment::kLeftForeArm:
      return {0.0, 0.05, 0.0};
    case Segment::kLeftHand:
      return {0.0, 0.02, 0.0};
    case Segment::kLeftUpperLeg:
      return {0.0, 0.08, 0.0};
    case Segment::kLeftLowerLeg:
      return {0.04, 0.03, 0.0};
    case Segment::kLeftFoot:
      return {0.0, 0.0, 0.03};
    case Segment::kLeftToe:
      return {0.0, 0.0, 0.02};
    case Segment::kLeftShoulder:
      return {-0.02, 0.0, 0.04};
    case Segment::kHead:
      return {-0.10, 0.0, 0.0};
    default:
      return {-0.12, 0.0, 0.0};
  }
}

}  // namespace

Eigen::Vector3d SkinOffset_m(Segment segment) {
  constexpr std::size_t kToLeft = 4;  // the segments of a left limb follow those of the right one
  if (!IsRight(segment)) {
    return LeftSkin_m(segment);
  }
  Eigen::Vector3d skin_m = LeftSkin_m(static_cast<Segment>(Index(segment) + kToLeft));
  skin_m.y() = -skin_m.y();
  return skin_m;
}

Eigen::Vector3d UsualSensorPlace_m(const BodyDefinition& body, Segment segment) {
  const SegmentDefinition* const definition = Find(body, segment);
  return definition == nullptr
             ? Eigen::Vector3d(Eigen::Vector3d::Zero())
             : Eigen::Vector3d(0.5 * definition->p_segment_end_m + SkinOffset_m(segment));
}

}  // namespace limbcast::body
