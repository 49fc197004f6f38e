#include "common/simulation/sensor_set.hpp"

#include <array>
#include <numbers>
#include <string>

#include "common/body/default_body.hpp"
#include "common/body/sensor_place.hpp"
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
  SensorMounting mounting;
  mounting.p_segment_sensor_m =
      0.5 * shape.p_segment_end_m[body::Index(segment)] + body::SkinOffset_m(segment);

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
