#include "services/fusion/sequence_tracker.hpp"

namespace limbcast::fusion {

void SequenceTracker::Rebase(std::uint32_t sequence) {
  started_ = true;
  newest_ = sequence;
  seen_ = 1;
}

SequenceTracker::Arrival SequenceTracker::Arrive(std::uint32_t sequence, Time measured_at) {
  if (sequence == 0) {
    return {};
  }
  if (!started_) {
    Rebase(sequence);  // what came before we listened is not lost
    return {};
  }
  if (sequence > newest_) {
    const std::uint32_t step = sequence - newest_;
    seen_ = step < kWindow ? (seen_ << step) | 1U : 1U;
    newest_ = sequence;
    return {.duplicate = false, .lost = static_cast<std::int64_t>(step) - 1};
  }
  const std::uint32_t back = newest_ - sequence;
  if (back > 0 && used_ && measured_at > newest_used_at_) {
    Rebase(sequence);
    return {.duplicate = false, .lost = static_cast<std::int64_t>(sequence) - 1};
  }
  if (back >= kWindow) {
    return {};  // too old to know; its time tells
  }
  const std::uint64_t bit = std::uint64_t{1} << back;
  if ((seen_ & bit) != 0) {
    return {.duplicate = true, .lost = 0};
  }
  seen_ |= bit;
  return {.duplicate = false, .lost = -1};
}

void SequenceTracker::Used(std::uint32_t sequence, Time measured_at) {
  used_ = true;
  newest_used_at_ = measured_at;
  if (sequence != 0 && started_ && sequence < newest_ && newest_ - sequence >= kWindow) {
    Rebase(sequence);
  }
}

}  // namespace limbcast::fusion
