#include "common/simulation/sensor_set.hpp"

#include <array>
#include <numbers>
#include <string>

#include "common/body/default_body.hpp"
#include "common/math/rotation.hpp"
#include "common/simulation/random.hpp"

namespace limbcast::simulation {
namespace {

using body::Segment;

constexpr std::array<Segment, 17> kStandard = {Segment::kPelvis,        Segment::kT8,
                                               Segment::kHead,          Segment::kRightShoulder,
                                               Segment::kRightUpperArm, Segment::kRightForeArm,
                                               Segment::kRightHand,     Segment::kLeftShoulder,
                                               Segment::kLeftUpperArm,  Segment::kLeftForeArm,
                                               Segment::kLeftHand,      Segment::kRightUpperLeg,
                                               Segment::kRightLowerLeg, Segment::kRightFoot,
                                               Segment::kLeftUpperLeg,  Segment::kLeftLowerLeg,
                                               Segment::kLeftFoot};

// How far, and to which side, the skin is from the bone, in the segment's axes (left side).
Eigen::Vector3d Skin_m(Segment left) {
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

bool IsRight(Segment segment) {
  return (segment >= Segment::kRightShoulder && segment <= Segment::kRightHand) ||
         (segment >= Segment::kRightUpperLeg && segment <= Segment::kRightToe);
}

}  // namespace

std::span<const Segment> SegmentsOf(SensorSet set) {
  switch (set) {
    case SensorSet::kReduced15:
      return body::ReducedSegments();
    case SensorSet::kStandard17:
      return kStandard;
    case SensorSet::kAll23:
      break;
  }
  return body::AllSegments();
}

SensorMounting MakeMounting(Segment segment, const PersonShape& shape, MountingStyle style,
                            std::uint64_t seed) {
  const bool right = IsRight(segment);
  Eigen::Vector3d skin_m = Skin_m(right ? static_cast<Segment>(body::Index(segment) + 4) : segment);
  if (right) {
    skin_m.y() = -skin_m.y();
  }
  SensorMounting mounting;
  mounting.p_segment_sensor_m = 0.5 * shape.p_segment_end_m[body::Index(segment)] + skin_m;

  Random random(seed, "mounting " + std::string(body::ToString(segment)));
  constexpr double kRough_rad = 15.0 * std::numbers::pi / 180.0;
  if (style == MountingStyle::kArbitrary) {
    mounting.q_segment_sensor = random.Rotation();
  } else if (style == MountingStyle::kRough) {
    mounting.q_segment_sensor =
        math::ExpSO3(random.Uniform(0.0, kRough_rad) * random.Gaussian3().normalized());
  }
  return mounting;
}

}  // namespace limbcast::simulation
