#include "common/simulation/person_shape.hpp"

#include <cmath>
#include <string>

#include "common/body/default_body.hpp"

namespace limbcast::simulation {
namespace {

using body::Index;
using body::Segment;

constexpr double kHeelPerAnkleToBall = 0.037 / 0.075;  // the table of common/body/default_body.cpp

Error Invalid(std::string message) {
  return Error{ErrorCode::kInvalidArgument, std::move(message)};
}

bool StraightDown(const Eigen::Vector3d& p_m) {
  return p_m.head<2>().norm() < 1e-6 && p_m.z() < -0.1 && p_m.z() > -0.7;
}

bool Mirrored(const Eigen::Vector3d& right_m, const Eigen::Vector3d& left_m) {
  return (right_m - Eigen::Vector3d(left_m.x(), -left_m.y(), left_m.z())).norm() < 1e-3;
}

}  // namespace

Result<PersonShape> MakePersonShape(const body::BodyDefinition& body) {
  PersonShape shape;
  std::array<bool, body::kSegmentCount> there{};
  for (const body::SegmentDefinition& segment : body.segments) {
    const std::size_t i = Index(segment.segment);
    there[i] = true;
    shape.p_parent_segment_m[i] = segment.p_parent_segment_m;
    shape.p_segment_end_m[i] = segment.p_segment_end_m;
  }
  for (const Segment segment : body::AllSegments()) {
    if (!there[Index(segment)]) {
      return Invalid("the simulated person needs all 23 segments, " +
                     std::string(body::ToString(segment)) + " is missing");
    }
  }
  shape.p_parent_segment_m[Index(Segment::kPelvis)].setZero();
  const auto parent = [&shape](Segment s) { return shape.p_parent_segment_m[Index(s)]; };
  for (const auto& [lower, foot] : {std::pair{Segment::kRightLowerLeg, Segment::kRightFoot},
                                    std::pair{Segment::kLeftLowerLeg, Segment::kLeftFoot}}) {
    if (!StraightDown(parent(lower)) || !StraightDown(parent(foot))) {
      return Invalid(
          "the simulated person needs legs that are straight down and 0.1 to 0.7 m in "
          "each half");
    }
  }
  for (const Segment right : {Segment::kRightUpperLeg, Segment::kRightLowerLeg, Segment::kRightFoot,
                              Segment::kRightToe}) {
    if (!Mirrored(parent(right), parent(static_cast<Segment>(Index(right) + 4)))) {
      return Invalid("the simulated person needs legs that are alike within 1 mm");
    }
  }
  shape.hip_half_m = parent(Segment::kLeftUpperLeg).y();
  shape.upper_leg_m = -parent(Segment::kLeftLowerLeg).z();
  shape.lower_leg_m = -parent(Segment::kLeftFoot).z();
  const Eigen::Vector3d p_ankle_ball_m = parent(Segment::kLeftToe);
  shape.ball_forward_m = p_ankle_ball_m.x();
  shape.ball_height_m = std::max(0.0, -shape.p_segment_end_m[Index(Segment::kLeftToe)].z());
  shape.ankle_height_m = shape.ball_height_m - p_ankle_ball_m.z();
  shape.heel_back_m = kHeelPerAnkleToBall * shape.ball_forward_m;
  if (!(shape.ball_forward_m > 0.0 && shape.ankle_height_m > 0.0 && shape.hip_half_m > 0.0)) {
    return Invalid("the simulated person needs toes before, and soles under, the ankles");
  }
  return shape;
}

Result<PersonShape> MakePersonShape(double height_m) {
  if (!(height_m >= 1.2 && height_m <= 2.2)) {
    return Invalid("height_m of the simulated person must be in [1.2, 2.2], is " +
                   std::to_string(height_m));
  }
  const auto body = body::MakeDefaultBody(BodyId{1}, height_m);
  if (!body) {
    return body.error();
  }
  return MakePersonShape(*body);
}

}  // namespace limbcast::simulation
