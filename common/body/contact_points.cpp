#include "common/body/contact_points.hpp"

#include <algorithm>
#include <array>

namespace limbcast::body {
namespace {

constexpr double kHeelPerBall = 0.037 / 0.075;
constexpr double kSolePerBallDrop = 0.039 / 0.027;
constexpr double kKneeRadius = 0.03 / 0.53;
constexpr double kSeatRadius = 0.09 / 0.53;

struct Leg {
  Segment upper;
  Segment lower;
  Segment foot;
  Segment toe;
};
constexpr std::array<Leg, 2> kLegs = {
    {{Segment::kRightUpperLeg, Segment::kRightLowerLeg, Segment::kRightFoot, Segment::kRightToe},
     {Segment::kLeftUpperLeg, Segment::kLeftLowerLeg, Segment::kLeftFoot, Segment::kLeftToe}}};

std::uint32_t Bit(Segment segment) { return 1U << Index(segment); }

void AddFoot(const Leg& leg, const BodyDefinition& body, std::vector<ContactPoint>& points) {
  const SegmentDefinition* foot = Find(body, leg.foot);
  if (foot == nullptr) {
    return;
  }
  const Eigen::Vector3d& p_ankle_ball_m = foot->p_segment_end_m;
  const SegmentDefinition* toe = Find(body, leg.toe);
  const double sole_m = toe != nullptr ? toe->p_parent_segment_m.z() + toe->p_segment_end_m.z()
                                       : kSolePerBallDrop * p_ankle_ball_m.z();
  const std::vector<Segment> measured = {leg.upper, leg.lower};
  points.push_back({.segment = leg.foot,
                    .p_segment_point_m = {-kHeelPerBall * p_ankle_ball_m.x(), 0.0, sole_m},
                    .radius_m = 0.0,
                    .measured = measured,
                    .contacts = Bit(leg.foot)});
  points.push_back({.segment = leg.foot,
                    .p_segment_point_m = p_ankle_ball_m,
                    .radius_m = std::max(0.0, p_ankle_ball_m.z() - sole_m),
                    .measured = measured,
                    .contacts = Bit(leg.foot) | (toe != nullptr ? Bit(leg.toe) : 0U)});
}

}  // namespace

std::vector<ContactPoint> MakeContactPoints(const BodyDefinition& body) {
  std::vector<ContactPoint> points;
  double leg_m = 0.0;
  for (const Leg& leg : kLegs) {
    AddFoot(leg, body, points);
    const SegmentDefinition* upper = Find(body, leg.upper);
    const SegmentDefinition* lower = Find(body, leg.lower);
    if (upper == nullptr || lower == nullptr) {
      continue;
    }
    leg_m = std::max(leg_m, upper->p_segment_end_m.norm() + lower->p_segment_end_m.norm());
    points.push_back({.segment = leg.lower,
                      .p_segment_point_m = Eigen::Vector3d::Zero(),
                      .radius_m = kKneeRadius * leg_m,
                      .measured = {leg.upper},
                      .contacts = Bit(leg.lower)});
  }
  if (leg_m > 0.0) {
    points.push_back({.segment = Segment::kPelvis,
                      .p_segment_point_m = Eigen::Vector3d::Zero(),
                      .radius_m = kSeatRadius * leg_m,
                      .measured = {Segment::kPelvis},
                      .contacts = Bit(Segment::kPelvis)});
  }
  return points;
}

}  // namespace limbcast::body
