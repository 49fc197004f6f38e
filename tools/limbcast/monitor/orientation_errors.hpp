#pragma once

#include <Eigen/Geometry>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <map>
#include <optional>
#include <utility>
#include <vector>

#include "common/base/time.hpp"
#include "common/body/segment_state.hpp"
#include "common/body/segment_truth.hpp"
#include "common/body/skeleton.hpp"

namespace limbcast::tool {

/// Angles between what the pipeline says and the truth at the same measured_at. The truth is
/// interpolated between its two neighbours, so it may come at another rate, and after what is
/// judged. Skeletons are judged where the truth knows the segment (simulator), segment states where
/// it knows only the sensor (optical recordings). Thread-compatible.
class OrientationErrors {
 public:
  /// Only what was measured at or after `time` counts. At first nothing does.
  void CountFrom(Time time) { count_from_ = time; }

  void AddTruth(const body::SegmentTruth& truth);
  void AddSkeleton(const body::Skeleton& skeleton);
  void AddSegmentState(const body::SegmentState& state);

  struct Summary {
    double rms_rad = 0.0;
    double max_rad = 0.0;
    std::uint64_t count = 0;
  };
  /// Of everything that was judged so far; nothing before the first.
  [[nodiscard]] std::optional<Summary> Get() const;
  /// The same by body and segment.
  using Key = std::pair<BodyId, body::Segment>;
  [[nodiscard]] std::map<Key, Summary> BySegment() const;

 private:
  struct Judged {  // waits for a truth that is as new
    Time measured_at{};
    Eigen::Quaterniond q_earth_any = Eigen::Quaterniond::Identity();
  };
  struct Track {
    std::deque<body::SegmentTruth> truths;
    std::deque<Judged> segments;
    std::deque<Judged> sensors;
    double sum_squares_rad2 = 0.0;
    double max_rad = 0.0;
    std::uint64_t count = 0;
  };
  enum class Level : std::uint8_t { kSegment, kSensor };

  void Judge(Track& track, std::deque<Judged>& waiting, Level level);

  std::optional<Time> count_from_;
  std::map<Key, Track> tracks_;
};

}  // namespace limbcast::tool
