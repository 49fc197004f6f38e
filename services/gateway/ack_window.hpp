#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "common/base/time.hpp"

namespace limbcast::gateway {

/// Flow control by acknowledgement: how much is under way on each of several lanes (a lane is one
/// sensor, or one body). What was sent carries a token that grows (a sequence number, a time). A
/// lane answers in order, so an answer beyond a token means that this one's will not come.
///
/// A lane that let a deadline pass is silent: it holds nobody up any more and what is sent on it
/// counts as lost at once, until it answers again. Thread-compatible.
class AckWindow {
 public:
  /// What an answer says of the older tokens of its lane that were not answered.
  enum class Older : std::uint8_t {
    kLost,      ///< each has an answer of its own, so those are lost (segment states)
    kAnswered,  ///< one answer may stand for several (skeletons)
  };

  /// At most `depth` (≥ 1) unanswered on each lane; one unanswered for `deadline` counts as lost.
  AckWindow(std::size_t depth, Duration deadline, Older older);

  /// Adds a lane and gives its index. One from which no answer is `expected` is left alone until it
  /// answers.
  std::size_t AddLane(bool expected);

  /// `token` > all before it on this lane. On a full lane, the oldest counts as lost.
  void Sent(std::size_t lane, std::int64_t token, Time now);

  /// True when it was waited for; else it came after its deadline, or twice.
  bool Answered(std::size_t lane, std::int64_t token);

  /// Something else came from this lane: it answers.
  void Heard(std::size_t lane) { SetState(lanes_[lane], State::kAnswering); }

  /// Counts what is over its deadline as lost, and gives how many.
  std::uint64_t Expire(Time now);

  /// When the next one will be over its deadline.
  [[nodiscard]] std::optional<Time> NextDeadline() const;

  /// Some lane holds `depth` unanswered.
  [[nodiscard]] bool full() const { return full_lanes_ > 0; }
  /// No lane answers: the window says nothing about what the other side can take.
  [[nodiscard]] bool silent() const { return answering_ == 0; }
  /// Makes every lane silent, as if its deadline had passed.
  void Silence();
  [[nodiscard]] bool empty() const { return under_way_ == 0; }
  [[nodiscard]] std::uint64_t lost() const { return lost_; }
  [[nodiscard]] std::uint64_t lost(std::size_t lane) const { return lanes_[lane].lost; }
  [[nodiscard]] std::uint64_t late() const { return late_; }

 private:
  struct Entry {
    std::int64_t token = 0;
    Time sent_at{};
  };
  enum class State : std::uint8_t { kNotExpected, kAnswering, kSilent };
  struct Lane {
    State state = State::kNotExpected;
    std::vector<Entry> ring;
    std::size_t begin = 0;
    std::size_t size = 0;
    std::uint64_t lost = 0;
    std::int64_t newest = 0;  // token sent last
  };
  void SetState(Lane& lane, State state);
  [[nodiscard]] const Entry& Oldest(const Lane& lane) const { return lane.ring[lane.begin]; }
  void Pop(Lane& lane, bool as_lost);

  std::size_t depth_;
  Duration deadline_;
  Older older_;
  std::vector<Lane> lanes_;
  std::size_t full_lanes_ = 0;
  std::size_t answering_ = 0;  // lanes
  std::size_t under_way_ = 0;
  std::uint64_t lost_ = 0;
  std::uint64_t late_ = 0;
};

}  // namespace limbcast::gateway
