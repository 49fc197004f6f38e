#include "common/bus/endpoint_events.hpp"

namespace limbcast::bus {

void EventSink::Emit(const BusEvent& event) {
  const std::scoped_lock lock(mutex_);
  if (handler_) {
    handler_(event);
  }
}

void EventSink::Close() {
  const std::scoped_lock lock(mutex_);
  handler_ = nullptr;
}

void EndpointEvents::Emit(BusEventKind kind, std::int64_t count, std::string_view detail) {
  sink_->Emit({.kind = kind,
               .topic = topic_,
               .from_writer = from_writer_,
               .count = count,
               .detail = std::string(detail)});
}

void EndpointEvents::Matched(std::int32_t change, std::int32_t now) {
  matched_ = now;
  if (change != 0) {
    Emit(change > 0 ? BusEventKind::kMatched : BusEventKind::kUnmatched, now);
  }
}

void EndpointEvents::IncompatibleQos(std::int64_t more, std::string_view policy) {
  incompatible_qos_ += static_cast<std::uint64_t>(more);
  Emit(BusEventKind::kIncompatibleQos, more, policy);
}

void EndpointEvents::Lost(std::int64_t more) {
  lost_ += static_cast<std::uint64_t>(more);
  Emit(BusEventKind::kSampleLost, more);
}

void EndpointEvents::Rejected(std::int64_t more, std::string_view why) {
  rejected_ += static_cast<std::uint64_t>(more);
  Emit(BusEventKind::kSampleRejected, more, why);
}

void EndpointEvents::Malformed(std::string_view why) {
  ++malformed_;
  Emit(BusEventKind::kMalformed, 1, why);
}

void EndpointEvents::Liveliness(std::int32_t alive, std::int32_t silent) {
  const std::int32_t more_alive = alive - alive_writers_.exchange(alive);
  const std::int32_t more_silent = silent - silent_writers_.exchange(silent);
  if (more_silent > 0) {
    liveliness_lost_ += static_cast<std::uint64_t>(more_silent);
    Emit(BusEventKind::kLivelinessLost, alive);
  }
  if (more_alive > 0) {
    Emit(BusEventKind::kLivelinessGained, alive);
  }
}

EndpointCounters EndpointEvents::counters() const {
  return {.samples = samples_,
          .matched = matched_,
          .alive_writers = alive_writers_,
          .incompatible_qos = incompatible_qos_,
          .lost = lost_,
          .rejected = rejected_,
          .malformed = malformed_,
          .liveliness_lost = liveliness_lost_,
          .disposed = disposed_};
}

}  // namespace limbcast::bus
