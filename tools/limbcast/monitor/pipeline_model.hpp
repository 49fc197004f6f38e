#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <set>
#include <string>

#include "common/base/health.hpp"
#include "common/base/ids.hpp"
#include "common/base/time.hpp"
#include "common/body/segment_state.hpp"
#include "common/body/segment_truth.hpp"
#include "common/body/skeleton.hpp"
#include "common/roster/roster.hpp"
#include "tools/limbcast/monitor/health_ledger.hpp"
#include "tools/limbcast/monitor/orientation_errors.hpp"
#include "tools/limbcast/monitor/position_errors.hpp"
#include "tools/limbcast/monitor/stage_latencies.hpp"

namespace limbcast::tool {

/// What a client knows of one segment.
struct SegmentView {
  body::SegmentState last;
  std::uint64_t states = 0;
  Time last_received_at{};
};

/// What a client knows of one body.
struct BodyView {
  std::string person;
  body::Skeleton last;
  std::uint64_t skeletons = 0;   ///< since the first that had a tracked segment
  std::uint64_t incomplete = 0;  ///< of these, those that lacked a segment in their tick
  std::uint64_t lost = 0;        ///< gaps in the numbers of the skeletons
  Duration longest_step{};       ///< of measured_at from one skeleton to the next
  Time first_received_at{};
  Time last_received_at{};
  Time first_measured_at{};
  std::set<body::Segment> tracked;  ///< segments that ever were
  std::map<body::Segment, SegmentView> segments;
};

/// Everything that `limbcast top` and `limbcast demo` know of a pipeline, fed by samples of its
/// topics. Thread-compatible.
struct PipelineModel {
  void On(const ServiceHealth& value) { health.Add(value); }
  void On(const body::Skeleton& value, Time received_at);
  void On(const body::SegmentState& value, Time received_at);
  void On(const body::SegmentTruth& value);
  void On(const roster::RosterEntry& value) { bodies[value.body_id].person = value.person; }

  /// Latencies, CPU time and skeletons_since_mark count from now on; everything else goes on.
  void Mark();

  [[nodiscard]] std::uint64_t skeletons() const;
  [[nodiscard]] std::uint64_t skeletons_since_mark() const {
    return skeletons() - marked_skeletons;
  }
  [[nodiscard]] std::uint64_t tracked_segments() const;
  /// Mean over the bodies, each from its first to its last skeleton.
  [[nodiscard]] double skeleton_rate_hz() const;

  HealthLedger health;
  StageLatencies latencies;
  OrientationErrors errors;
  PositionErrors positions;
  bool judge_positions = false;  ///< costs this process something for each state
  std::map<BodyId, BodyView> bodies;
  std::uint64_t probe_skeletons = 0;   ///< that came before anything was tracked
  std::uint64_t marked_skeletons = 0;  ///< that had come at Mark
};

/// Where the samples went, from the counters of gateways and fusion services, over all restarts:
/// published = filtered + refused + lost.
struct Accounting {
  std::uint64_t published = 0;
  std::uint64_t filtered = 0;
  std::map<std::string, std::uint64_t> refused;  ///< by verdict, those that happened
  std::uint64_t lost = 0;                        ///< published and never given a verdict
  std::uint64_t lost_seen = 0;  ///< what fusion itself missed in the numbers of the samples
};
[[nodiscard]] Accounting Account(const HealthLedger& health);

}  // namespace limbcast::tool
