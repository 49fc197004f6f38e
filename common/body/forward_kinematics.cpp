#include "common/body/forward_kinematics.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "common/base/expects.hpp"
#include "common/body/alignment.hpp"
#include "common/body/default_body.hpp"
#include "common/body/joint_limits.hpp"
#include "common/math/rotation.hpp"

namespace limbcast::body {
namespace {

constexpr std::size_t kPelvis = Index(Segment::kPelvis);

constexpr double kRiseFrom_rad = std::numbers::pi / 6.0;
constexpr double kRisePerElevation = 0.12;

/// The joint that is limited by its angles when `segment` hangs on `parent`.
std::optional<Joint> LimitedJoint(std::uint8_t parent, Segment segment) {
  for (std::size_t i = 0; i < kJointCount; ++i) {
    const auto joint = static_cast<Joint>(i);
    const JointSegments segments = SegmentsOf(joint);
    if (segments.child == segment && segments.parent && Index(*segments.parent) == parent &&
        LimitsOf(joint)) {
      return joint;
    }
  }
  return std::nullopt;
}

}  // namespace

ForwardKinematics::ForwardKinematics(const BodyDefinition& body) {
  Expects(Validate(body).ok(), "a valid body definition");
  for (const SegmentDefinition& definition : body.segments) {
    Link link;
    link.segment = static_cast<std::uint8_t>(definition.segment);
    const int parent = ParentIndex(body, definition.segment);
    if (parent >= 0) {
      link.parent =
          static_cast<std::uint8_t>(body.segments[static_cast<std::size_t>(parent)].segment);
    }
    link.limited = (definition.joint_min_rad.array() <= definition.joint_max_rad.array()).any();
    link.joint = LimitedJoint(link.parent, definition.segment);
    link.p_parent_segment_m = definition.p_parent_segment_m;
    link.p_segment_end_m = definition.p_segment_end_m;
    link.joint_min_rad = definition.joint_min_rad;
    link.joint_max_rad = definition.joint_max_rad;
    links_.push_back(link);
    segments_.push_back(definition.segment);
    has_[link.segment] = true;
    p_segment_end_m_[link.segment] = definition.p_segment_end_m;
    if (definition.segment <= Segment::kT8) {
      trunk_.push_back(link.segment);
    }
  }
}

void ForwardKinematics::Fill(BodyPose& pose) const {
  PerSegment<bool> done = pose.known;
  FillPelvis(pose, done);
  FillTrunk(pose, done);

  constexpr std::size_t kT8 = Index(Segment::kT8);
  constexpr std::size_t kNeck = Index(Segment::kNeck);
  constexpr std::size_t kHead = Index(Segment::kHead);
  if (has_[kNeck] && has_[kT8] && !done[kNeck] && done[kHead]) {
    pose.q_earth_segment[kNeck] =
        math::Slerp(pose.q_earth_segment[kT8], pose.q_earth_segment[kHead], 0.5);
    pose.confidence[kNeck] =
        kFillConfidence * std::min(pose.confidence[kT8], pose.confidence[kHead]);
    done[kNeck] = true;
  }
  FillShoulder(Segment::kRightShoulder, Joint::kRightShoulder, pose, done);
  FillShoulder(Segment::kLeftShoulder, Joint::kLeftShoulder, pose, done);
  for (const Link& link : links_) {
    if (!done[link.segment] && link.parent != kNone) {
      pose.q_earth_segment[link.segment] = pose.q_earth_segment[link.parent];
      pose.confidence[link.segment] = kFillConfidence * pose.confidence[link.parent];
    }
  }
}

void ForwardKinematics::FillShoulder(Segment segment, Joint joint, BodyPose& pose,
                                     PerSegment<bool>& done) const {
  const std::size_t shoulder = Index(segment);
  const std::size_t arm = Index(SegmentsOf(joint).child);
  constexpr std::size_t kT8 = Index(Segment::kT8);
  if (!has_[shoulder] || done[shoulder] || !done[arm] || !has_[kT8] || !done[kT8]) {
    return;
  }
  const double elevation_rad =
      AnglesOf(joint, pose.q_earth_segment[kT8], pose.q_earth_segment[arm]).angle_rad[1];
  const double rise_rad = kRisePerElevation * std::max(0.0, elevation_rad - kRiseFrom_rad);
  const double up = segment == Segment::kLeftShoulder ? 1.0 : -1.0;  // +y, the left end, to +z
  pose.q_earth_segment[shoulder] =
      pose.q_earth_segment[kT8] * math::ExpSO3({up * rise_rad, 0.0, 0.0});
  pose.confidence[shoulder] =
      kFillConfidence * std::min(pose.confidence[kT8], pose.confidence[arm]);
  done[shoulder] = true;
}

void ForwardKinematics::FillPelvis(BodyPose& pose, PerSegment<bool>& done) const {
  if (done[kPelvis]) {
    return;
  }
  for (const Segment source : {Segment::kT8, Segment::kL3, Segment::kL5, Segment::kT12,
                               Segment::kRightUpperLeg, Segment::kLeftUpperLeg, Segment::kHead}) {
    if (done[Index(source)]) {
      pose.q_earth_segment[kPelvis] =
          HeadingRotation(math::Heading_rad(pose.q_earth_segment[Index(source)]));
      break;
    }
  }
  pose.confidence[kPelvis] = 0.0F;
  done[kPelvis] = true;
}

void ForwardKinematics::FillTrunk(BodyPose& pose, PerSegment<bool>& done) const {
  std::size_t low = 0;  // position in trunk_ of the last known one; the pelvis is known by now
  while (low + 1 < trunk_.size()) {
    std::size_t high = low + 1;
    while (high < trunk_.size() && !done[trunk_[high]]) {
      ++high;
    }
    const Eigen::Quaterniond& q_low = pose.q_earth_segment[trunk_[low]];
    const float confidence_low = pose.confidence[trunk_[low]];
    // The share of the turn counts vertebrae of the full model, also where some are left out.
    const auto place = [&](std::size_t i) { return static_cast<double>(trunk_[i]); };
    for (std::size_t i = low + 1; i < high; ++i) {
      const std::size_t segment = trunk_[i];
      if (high < trunk_.size()) {
        const double share = (place(i) - place(low)) / (place(high) - place(low));
        pose.q_earth_segment[segment] =
            math::Slerp(q_low, pose.q_earth_segment[trunk_[high]], share);
        pose.confidence[segment] =
            kFillConfidence * std::min(confidence_low, pose.confidence[trunk_[high]]);
      } else {
        pose.q_earth_segment[segment] = q_low;
        pose.confidence[segment] = kFillConfidence * confidence_low;
      }
      done[segment] = true;
    }
    low = high;
  }
}

void ForwardKinematics::LimitJoints(double softness_rad, BodyPose& pose) const {
  Expects(softness_rad > 0.0, "softness_rad > 0");
  for (const Link& link : links_) {
    if (link.parent == kNone || (!link.limited && !link.joint)) {
      continue;
    }
    const Eigen::Quaterniond& q_earth_parent = pose.q_earth_segment[link.parent];
    const Eigen::Quaterniond q_parent_segment =
        q_earth_parent.conjugate() * pose.q_earth_segment[link.segment];
    const Eigen::Quaterniond q_limited =
        link.joint ? SoftLimited(*link.joint, q_parent_segment, softness_rad)
                   : LimitedAsHinge(link, q_parent_segment, softness_rad);
    if (q_limited.coeffs() != q_parent_segment.coeffs()) {
      pose.q_earth_segment[link.segment] = q_earth_parent * q_limited;
    }
  }
}

Eigen::Quaterniond ForwardKinematics::LimitedAsHinge(const Link& link,
                                                     const Eigen::Quaterniond& q_parent_segment,
                                                     double softness_rad) {
  const Eigen::Vector3d turn_rad = math::LogSO3(q_parent_segment);
  Eigen::Vector3d limited_rad;
  for (Eigen::Index axis = 0; axis < 3; ++axis) {
    limited_rad[axis] =
        SoftClamp(turn_rad[axis], link.joint_min_rad[axis], link.joint_max_rad[axis], softness_rad);
  }
  return limited_rad == turn_rad ? q_parent_segment : math::ExpSO3(limited_rad);
}

void ForwardKinematics::Place(const Eigen::Vector3d& p_earth_root_m, BodyPose& pose) const {
  for (const Link& link : links_) {
    pose.p_earth_segment_m[link.segment] =
        link.parent == kNone
            ? p_earth_root_m
            : Eigen::Vector3d(pose.p_earth_segment_m[link.parent] +
                              pose.q_earth_segment[link.parent] * link.p_parent_segment_m);
  }
}

Eigen::Vector3d ForwardKinematics::End_m(Segment segment, const BodyPose& pose) const {
  const std::size_t i = Index(segment);
  Expects(i < kSegmentCount && has_[i], "a segment of this body");
  return pose.p_earth_segment_m[i] + pose.q_earth_segment[i] * p_segment_end_m_[i];
}

}  // namespace limbcast::body
