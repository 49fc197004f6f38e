#pragma once

#include <cstdint>

#include "common/base/time.hpp"

namespace limbcast::fusion {

/// Follows the numbers that a gateway gives to one sensor's samples: what came twice, what never
/// came, and when a gateway has started to count again. Judges numbers only; whether a time fits is
/// for the filter to say. Number 0 means "not numbered" and is never judged. Thread-compatible.
class SequenceTracker {
 public:
  struct Arrival {
    bool duplicate = false;  ///< this number has been here
    std::int64_t lost = 0;   ///< how many more are missing; -1: one that was missing came late
  };

  /// The next sample as it came. A lower number with a time after the newest used one is a gateway
  /// that started again at 1.
  Arrival Arrive(std::uint32_t sequence, Time measured_at);

  /// The sample that arrived last was used, so its time is the one to compare with; a number far
  /// back then is the new count (the filter has accepted a clock that was set back).
  void Used(std::uint32_t sequence, Time measured_at);

 private:
  void Rebase(std::uint32_t sequence);

  static constexpr std::uint32_t kWindow = 64;  // numbers remembered one by one
  bool started_ = false;
  bool used_ = false;
  std::uint32_t newest_ = 0;
  std::uint64_t seen_ = 0;  // bit i: newest_ - i has been here
  Time newest_used_at_{};
};

}  // namespace limbcast::fusion
