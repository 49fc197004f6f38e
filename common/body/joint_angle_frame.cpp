#include "common/body/joint_angle_frame.hpp"

#include <algorithm>
#include <array>

#include "common/base/expects.hpp"

namespace limbcast::body {

void FillJointAngles(const Skeleton& skeleton, JointAngleFrame& frame) {
  std::array<const SegmentPose*, kSegmentCount> poses{};
  for (const SegmentPose& pose : skeleton.segments) {
    Expects(Index(pose.segment) < kSegmentCount, "a known segment");
    poses[Index(pose.segment)] = &pose;
  }
  frame.body_id = skeleton.body_id;
  frame.sequence = skeleton.sequence;
  frame.measured_at = skeleton.measured_at;
  frame.joints.clear();
  for (std::size_t i = 0; i < kJointCount; ++i) {
    const auto joint = static_cast<Joint>(i);
    const auto [parent, child] = SegmentsOf(joint);
    const SegmentPose* outer = poses[Index(child)];
    const SegmentPose* inner = parent ? poses[Index(*parent)] : nullptr;
    if (outer == nullptr || (parent && inner == nullptr)) {
      continue;
    }
    const auto orientation = [](const SegmentPose& pose) {
      return pose.q_earth_segment.cast<double>().normalized();
    };
    const JointAngles angles =
        AnglesOf(joint, inner == nullptr ? Eigen::Quaterniond::Identity() : orientation(*inner),
                 orientation(*outer));
    frame.joints.push_back(
        {.joint = joint,
         .near_singular = angles.near_singular,
         .confidence = std::min(outer->confidence, inner == nullptr ? 1.0F : inner->confidence),
         .angle_rad = angles.angle_rad.cast<float>()});
  }
}

}  // namespace limbcast::body
