#pragma once

#include <Eigen/Geometry>
#include <algorithm>
#include <cstdint>
#include <vector>

#include "common/base/ids.hpp"
#include "common/base/time.hpp"
#include "common/body/segment.hpp"
#include "common/body/stage_times.hpp"

namespace limbcast::body {

/// How a segment of a skeleton came about. Numbers are part of the wire contract.
enum class SegmentStatus : std::uint8_t {
  kMissing = 0,  ///< a sensor is expected, but nothing was ever heard of it, or not for long; the
                 ///< pose is a guess
  kTracked = 1,  ///< measured in this tick
  kStale = 2,    ///< its last measurement is older than this tick; held or predicted
  kFilled = 3,   ///< carries no sensor: taken from its neighbours
};

/// One segment in the earth frame.
struct SegmentPose {
  Segment segment = Segment::kPelvis;
  SegmentStatus status = SegmentStatus::kMissing;
  float confidence = 0.0F;  ///< 0 (a guess) to 1
  Eigen::Quaternionf q_earth_segment = Eigen::Quaternionf::Identity();
  Eigen::Vector3f p_earth_segment_m = Eigen::Vector3f::Zero();  ///< inboard end
};

/// One person at one instant: what a virtual-environment client draws.
struct Skeleton {
  BodyId body_id;
  std::uint32_t sequence = 0;             ///< counts the skeletons of this body, from 1
  std::uint32_t definition_revision = 0;  ///< the BodyDefinition it was computed with
  Time measured_at{};                     ///< the instant the pose is true
  StageTimes stages;
  bool complete = false;              ///< every expected segment was measured in this tick
  std::uint32_t contacts = 0;         ///< bit i set: segment i is on the ground
  std::vector<SegmentPose> segments;  ///< in the order of the definition; at most 32
};

/// False for a skeleton that only answers a probe, or of a person of whom nothing is heard now.
[[nodiscard]] inline bool AnyTracked(const Skeleton& skeleton) {
  return std::any_of(
      skeleton.segments.begin(), skeleton.segments.end(),
      [](const SegmentPose& pose) { return pose.status == SegmentStatus::kTracked; });
}

}  // namespace limbcast::body
