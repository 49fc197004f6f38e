#include "common/client/skeleton_history.hpp"

#include <algorithm>

#include "common/base/expects.hpp"
#include "common/math/rotation.hpp"

namespace limbcast::client {
namespace {

// Rates are taken over at least this long: a shorter base makes noise of them.
constexpr Duration kRateBase = std::chrono::milliseconds(20);

bool SameSegments(const body::Skeleton& a, const body::Skeleton& b) {
  return a.definition_revision == b.definition_revision &&
         std::equal(a.segments.begin(), a.segments.end(), b.segments.begin(), b.segments.end(),
                    [](const auto& x, const auto& y) { return x.segment == y.segment; });
}

Pose Held(const body::Skeleton& skeleton) {
  Pose pose;
  pose.at = skeleton.measured_at;
  pose.measured_at = skeleton.measured_at;
  pose.definition_revision = skeleton.definition_revision;
  pose.segments = skeleton.segments;
  return pose;
}

/// From a (t = 0) to b (t = 1) and beyond.
void Blend(const body::Skeleton& a, const body::Skeleton& b, double t,
           const body::ForwardKinematics* kinematics, std::vector<body::SegmentPose>& segments) {
  segments = t < 0.5 ? a.segments : b.segments;
  body::BodyPose placed;
  for (std::size_t i = 0; i < segments.size(); ++i) {
    const body::SegmentPose& from = a.segments[i];
    const body::SegmentPose& to = b.segments[i];
    const Eigen::Quaterniond q =
        math::Canonical(math::Slerp(from.q_earth_segment.cast<double>().normalized(),
                                    to.q_earth_segment.cast<double>().normalized(), t));
    const Eigen::Vector3d p_m = from.p_earth_segment_m.cast<double>() +
                                t * (to.p_earth_segment_m - from.p_earth_segment_m).cast<double>();
    placed.q_earth_segment[body::Index(segments[i].segment)] = q;
    placed.p_earth_segment_m[body::Index(segments[i].segment)] = p_m;
    segments[i].q_earth_segment = q.cast<float>();
    segments[i].confidence = std::min(from.confidence, to.confidence);
  }
  if (kinematics != nullptr) {
    kinematics->Place(placed.p_earth_segment_m[body::Index(body::Segment::kPelvis)], placed);
  }
  for (body::SegmentPose& segment : segments) {
    segment.p_earth_segment_m =
        placed.p_earth_segment_m[body::Index(segment.segment)].cast<float>();
  }
}

double Share(Time at, Time from, Time to) { return ToSeconds(at - from) / ToSeconds(to - from); }

}  // namespace

SkeletonHistory::SkeletonHistory(std::size_t capacity) : ring_(capacity) {
  Expects(capacity >= 2 && capacity <= 4096, "a capacity in [2, 4096]");
}

void SkeletonHistory::Add(const body::Skeleton& skeleton) {
  if (count_ > 0 && skeleton.measured_at <= latest().measured_at) {
    count_ = 0;
  }
  ring_[next_] = skeleton;
  next_ = (next_ + 1) % ring_.size();
  count_ = std::min(count_ + 1, ring_.size());
}

std::optional<Pose> SkeletonHistory::At(Time at, Duration max_prediction,
                                        const body::ForwardKinematics* kinematics) const {
  if (empty()) {
    return std::nullopt;
  }
  Pose pose = Held(latest());
  std::size_t back = 1;
  if (at > latest().measured_at) {
    while (back < count_ && latest().measured_at - Back(back).measured_at < kRateBase) {
      ++back;
    }
    back = std::min(back, count_ - 1);
    if (back > 0 && max_prediction > Duration::zero() && SameSegments(Back(back), latest())) {
      pose.source = PoseSource::kPredicted;
      pose.at = std::min(at, latest().measured_at + max_prediction);
      Blend(Back(back), latest(), Share(pose.at, Back(back).measured_at, latest().measured_at),
            kinematics, pose.segments);
    }
  } else if (at < latest().measured_at) {
    while (back < count_ && at < Back(back).measured_at) {
      ++back;
    }
    if (back == count_) {
      pose = Held(Back(count_ - 1));  // asked for what is older than all that is kept
    } else if (SameSegments(Back(back), Back(back - 1))) {
      const body::Skeleton& after = Back(back - 1);
      pose.source = PoseSource::kInterpolated;
      pose.at = at;
      pose.measured_at = after.measured_at;
      Blend(Back(back), after, Share(at, Back(back).measured_at, after.measured_at), kinematics,
            pose.segments);
    } else {
      pose = Held(Back(back));
    }
  }
  pose.age = at - pose.measured_at;
  return pose;
}

}  // namespace limbcast::client
