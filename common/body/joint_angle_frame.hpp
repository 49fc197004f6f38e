#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "common/base/ids.hpp"
#include "common/base/time.hpp"
#include "common/body/joint_angles.hpp"
#include "common/body/skeleton.hpp"

namespace limbcast::body {

/// The angles of one joint as they travel; what they mean: AnglesOf, AngleNames.
struct JointAngle {
  Joint joint = Joint::kPelvis;
  bool near_singular = false;  ///< first and third angle mean nothing one by one
  float confidence = 0.0F;     ///< the lesser of its two segments', 0 (a guess) to 1
  Eigen::Vector3f angle_rad = Eigen::Vector3f::Zero();
};

/// All joint angles of one skeleton.
struct JointAngleFrame {
  BodyId body_id;
  std::uint32_t sequence = 0;      ///< that of the skeleton
  Time measured_at{};              ///< that of the skeleton
  std::vector<JointAngle> joints;  ///< those both of whose segments the body has; at most 32
};

/// The angles of a skeleton. Allocates nothing once frame.joints has room for kJointCount.
void FillJointAngles(const Skeleton& skeleton, JointAngleFrame& frame);

}  // namespace limbcast::body
