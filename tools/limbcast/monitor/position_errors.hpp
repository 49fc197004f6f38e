#pragma once

#include <Eigen/Geometry>
#include <cstdint>
#include <deque>
#include <map>
#include <optional>
#include <utility>

#include "common/base/time.hpp"
#include "common/body/segment_state.hpp"
#include "common/body/segment_truth.hpp"
#include "common/body/skeleton.hpp"

namespace limbcast::tool {

/// Positions beside the truth of the same instant. A sensor that is tracked from another one (by
/// coils) is judged in that one's axes, where the orientation of both takes no part; one in the
/// earth frame (by a marker) in the earth frame; a segment of the skeleton by its inboard end
/// against the pelvis, the pelvis itself in the earth frame. Thread-compatible.
class PositionErrors {
 public:
  /// Only what was measured at or after `time` counts. At first nothing does.
  void CountFrom(Time time) { count_from_ = time; }

  void AddTruth(const body::SegmentTruth& truth);
  void AddSegmentState(const body::SegmentState& state);
  void AddSkeleton(const body::Skeleton& skeleton);

  struct Summary {
    double rms_m = 0.0;
    double max_m = 0.0;
    double sigma_m = 0.0;  ///< RMS of what the filter says of itself, 3-D; of sensors only
    std::uint64_t count = 0;
  };
  using Key = std::pair<BodyId, body::Segment>;
  [[nodiscard]] const std::map<Key, Summary>& sensors() const { return sensors_; }
  /// The same sensors, smoothed with a lag.
  [[nodiscard]] const std::map<Key, Summary>& lagged() const { return lagged_; }
  [[nodiscard]] const std::map<Key, Summary>& joints() const { return joints_; }

 private:
  // What came of one body at one instant.
  struct Tick {
    Time at{};
    std::map<body::Segment, body::SegmentTruth> truths;
    std::map<body::Segment, body::SegmentState> states;
    std::map<body::Segment, body::SegmentState> lagged;
    std::optional<body::Skeleton> skeleton;
  };
  Tick& TickAt(BodyId body_id, Time at);
  void Judge(BodyId body_id, const Tick& tick);
  static void JudgeState(const Tick& tick, const body::SegmentState& state,
                         std::map<Key, Summary>& into);
  static void Add(Summary& summary, double error_m, double sigma_m);

  std::optional<Time> count_from_;
  std::map<BodyId, std::deque<Tick>> ticks_;  // by time
  std::map<Key, Summary> sensors_;
  std::map<Key, Summary> lagged_;
  std::map<Key, Summary> joints_;
};

}  // namespace limbcast::tool
