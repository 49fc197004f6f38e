#include "services/posture/tick_assembler.hpp"

#include <algorithm>

namespace limbcast::posture {

void TickAssembler::Expect(SegmentSet expected) {
  ever_ &= expected;
  heard_ &= expected;
  measured_ &= expected;
  awaited_ &= expected;
  expected_ = expected;
}

TickAssembler::Place TickAssembler::Classify(body::Segment segment, Time measured_at) const {
  if (last_closed_ && measured_at + kNewStartAfter < *last_closed_) {
    return Place::kNewStart;
  }
  if (Ever(segment) && measured_at <= last_heard_[body::Index(segment)]) {
    return Place::kOld;
  }
  if (last_closed_ && measured_at <= *last_closed_) {
    return Place::kLate;
  }
  return (heard_ & BitOf(segment)) != 0 ? Place::kNext : Place::kHere;
}

void TickAssembler::Add(body::Segment segment, Time measured_at, bool measured, Time now) {
  first_ = first_.value_or(measured_at);
  if (!open()) {
    opened_at_ = now;
    tick_at_ = measured_at;
    awaited_ = expected_ & ~missing(measured_at);
    if (measured_at - *first_ <= config_.missing_after) {
      awaited_ |= expected_ & ~ever_;
    }
  }
  tick_at_ = std::max(tick_at_, measured_at);
  heard_ |= BitOf(segment);
  ever_ |= BitOf(segment);
  measured_ |= measured ? BitOf(segment) : 0;
  last_heard_[body::Index(segment)] = measured_at;
}

void TickAssembler::AddLate(body::Segment segment, Time measured_at) {
  ever_ |= BitOf(segment);
  last_heard_[body::Index(segment)] = measured_at;
}

void TickAssembler::Close() {
  last_closed_ = tick_at_;
  opened_at_.reset();
  heard_ = 0;
  measured_ = 0;
}

void TickAssembler::Restart() {
  opened_at_.reset();
  heard_ = 0;
  measured_ = 0;
  ever_ = 0;
  first_.reset();
  last_closed_.reset();
}

std::optional<Time> TickAssembler::deadline() const {
  return opened_at_ ? std::optional(*opened_at_ + config_.deadline) : std::nullopt;
}

SegmentSet TickAssembler::missing(Time at) const {
  SegmentSet missing = expected_ & ~ever_;
  for (std::size_t i = 0; i < body::kSegmentCount; ++i) {
    const auto bit = SegmentSet{1} << i;
    if ((ever_ & bit) != 0 && at - last_heard_[i] > config_.missing_after) {
      missing |= bit;
    }
  }
  return missing;
}

}  // namespace limbcast::posture
