#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "common/body/body_definition.hpp"

namespace limbcast::body {

/// A place where a person can touch the ground: a ball of `radius_m` about a point of a segment.
struct ContactPoint {
  Segment segment = Segment::kPelvis;
  Eigen::Vector3d p_segment_point_m = Eigen::Vector3d::Zero();
  double radius_m = 0.0;
  /// The segments whose sensors must be usable for the point to be known against the pelvis.
  std::vector<Segment> measured;
  /// The segments that are on the ground when the point is, as in Skeleton::contacts.
  std::uint32_t contacts = 0;
};

/// Heel and ball of both feet, knees, and the seat; those whose segments the body has.
///
/// The foot rolls over its heel, a point of the sole behind the ankle, and then over the ball,
/// whose joint stays at the height at which it is while the foot is flat ("rockers" of Perry, "Gait
/// Analysis", chapter 3). Proportions as in default_body.cpp: the heel lies 0.037/0.075 of the
/// distance ankle–ball behind the ankle; without a toe segment the sole lies 0.039/0.027 of the
/// drop ankle–ball below the ankle. Knee (0.03) and seat (0.09 below the hips) are our guesses, in
/// fractions of the distance hip–sole, for kneeling and sitting on the ground.
[[nodiscard]] std::vector<ContactPoint> MakeContactPoints(const BodyDefinition& body);

}  // namespace limbcast::body
