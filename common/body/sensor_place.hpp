#pragma once

#include <Eigen/Core>

#include "common/body/body_definition.hpp"
#include "common/body/segment.hpp"

namespace limbcast::body {

/// How far, and to which side, the skin where a sensor is strapped on is from the bone, in the
/// segment's axes: outside of arms and legs, the shin's inner face, the back of the trunk, the
/// instep. Ours, for an average person.
[[nodiscard]] Eigen::Vector3d SkinOffset_m(Segment segment);

/// Where a sensor sits that nobody measured: in the middle of the segment, on the skin. From the
/// segment's inboard end, in its axes; zero for a segment that the body does not have.
[[nodiscard]] Eigen::Vector3d UsualSensorPlace_m(const BodyDefinition& body, Segment segment);

}  // namespace limbcast::body
