#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "common/base/time.hpp"
#include "common/body/forward_kinematics.hpp"
#include "common/body/skeleton.hpp"

namespace limbcast::client {

/// How a Pose came about.
enum class PoseSource : std::uint8_t {
  kInterpolated,  ///< between two skeletons
  kPredicted,     ///< from the last two, each segment turning on at its rate
  kHeld,          ///< as the newest (or oldest kept) skeleton: there is nothing to compute it from
};

/// One person at one instant.
struct Pose {
  Time at{};  ///< the instant it stands for; less than asked for when prediction is bounded
  Time measured_at{};  ///< of the newest skeleton it was made from
  Duration age{};      ///< asked-for instant minus measured_at; > 0: not measured (yet)
  PoseSource source = PoseSource::kHeld;
  std::uint32_t definition_revision = 0;
  std::vector<body::SegmentPose> segments;
};

/// The last skeletons of one body, and what the person looks like at any instant near them.
/// Thread-compatible.
class SkeletonHistory {
 public:
  /// Keeps `capacity` skeletons. Range: [2, 4096].
  explicit SkeletonHistory(std::size_t capacity);

  /// Takes the next one. One that is not newer than the last starts the history anew.
  void Add(const body::Skeleton& skeleton);

  [[nodiscard]] bool empty() const { return count_ == 0; }
  /// The newest. Not empty.
  [[nodiscard]] const body::Skeleton& latest() const { return Back(0); }

  /// The pose at `at`: rotations along the shorter arc, the root along a line, and the other
  /// positions by `kinematics` of the same definition so that limbs keep their lengths (a line for
  /// each without it). After the newest skeleton it is predicted, by at most `max_prediction`.
  /// Nothing when empty.
  [[nodiscard]] std::optional<Pose> At(Time at, Duration max_prediction,
                                       const body::ForwardKinematics* kinematics) const;

 private:
  [[nodiscard]] const body::Skeleton& Back(std::size_t steps) const {
    return ring_[(next_ + ring_.size() - 1 - steps) % ring_.size()];
  }

  std::vector<body::Skeleton> ring_;
  std::size_t next_ = 0;
  std::size_t count_ = 0;
};

}  // namespace limbcast::client
