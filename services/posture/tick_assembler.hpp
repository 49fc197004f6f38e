#pragma once

#include <cstdint>
#include <optional>

#include "common/base/time.hpp"
#include "common/body/forward_kinematics.hpp"
#include "common/body/segment.hpp"

namespace limbcast::posture {

/// A set of segments, bit Index(segment).
using SegmentSet = std::uint32_t;
[[nodiscard]] constexpr SegmentSet BitOf(body::Segment segment) {
  return SegmentSet{1} << body::Index(segment);
}

struct TickAssemblerConfig {
  Duration deadline = std::chrono::milliseconds(8);  ///< from first arrival to emission, at most
  Duration missing_after = std::chrono::seconds(2);  ///< silence after which nobody waits
};

/// Decides which states make one tick of one body, and when it is full. A tick is one newer state
/// of every segment that is waited for; it does not matter whether the sensors sample at the same
/// instants. Knows segments and times only. Thread-compatible.
///
/// Waited for is every expected segment that was heard within `missing_after` before the newest
/// state of the body, and, in that span after the first, those never heard: both in stream time,
/// so replay at any speed behaves alike.
class TickAssembler {
 public:
  enum class Place {
    kHere,      ///< belongs to the open tick, or opens one
    kNext,      ///< its segment has been heard in this tick: close that first, then Add
    kLate,      ///< not newer than the last tick that was closed
    kOld,       ///< not newer than what this segment had
    kNewStart,  ///< so much older than the last tick that the stream began anew: Restart first
  };

  explicit TickAssembler(TickAssemblerConfig config) : config_(config) {}

  /// The segments that carry sensors. Forgets what others had.
  void Expect(SegmentSet expected);

  [[nodiscard]] Place Classify(body::Segment segment, Time measured_at) const;

  /// Takes a state for which Classify said kHere. `measured` is false for an answer without
  /// orientation (link probe, refused sample): it counts as heard, not as measured.
  void Add(body::Segment segment, Time measured_at, bool measured, Time now);

  /// A late state: heard, part of no tick.
  void AddLate(body::Segment segment, Time measured_at);

  /// Ends the tick. The next state opens another.
  void Close();

  /// Forgets all times: the stream began anew.
  void Restart();

  [[nodiscard]] bool open() const { return opened_at_.has_value(); }
  /// Every segment that is waited for has been heard in this tick.
  [[nodiscard]] bool full() const { return open() && (awaited_ & ~heard_) == 0; }
  /// When the open tick is to be closed at the latest.
  [[nodiscard]] std::optional<Time> deadline() const;
  /// Instant of the tick: of its newest state. Of an open tick, or of the last closed one.
  [[nodiscard]] Time measured_at() const { return tick_at_; }
  [[nodiscard]] SegmentSet measured() const { return measured_; }
  [[nodiscard]] SegmentSet expected() const { return expected_; }
  /// Segments to be missed at `at`: never heard, or silent for longer than missing_after.
  [[nodiscard]] SegmentSet missing(Time at) const;

 private:
  // Older than the last tick by more than this cannot be a late sample.
  static constexpr Duration kNewStartAfter = std::chrono::seconds(1);

  [[nodiscard]] bool Ever(body::Segment segment) const { return (ever_ & BitOf(segment)) != 0; }

  TickAssemblerConfig config_;
  SegmentSet expected_ = 0;
  SegmentSet awaited_ = 0;               // of the open tick
  SegmentSet heard_ = 0;                 // in the open tick
  SegmentSet measured_ = 0;              // in the open tick, with an orientation
  SegmentSet ever_ = 0;                  // heard since the start
  body::PerSegment<Time> last_heard_{};  // stream time; only of those in ever_
  std::optional<Time> first_;            // stream time of the first state
  std::optional<Time> last_closed_;      // stream time of the last closed tick
  std::optional<Time> opened_at_;        // host clock
  Time tick_at_{};
};

}  // namespace limbcast::posture
