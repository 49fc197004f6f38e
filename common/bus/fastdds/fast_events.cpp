#include "common/bus/fastdds/fast_events.hpp"

#include <utility>

namespace limbcast::bus::fastdds {

void FastEvents::Raise(BusEventKind kind, std::int64_t count, std::string detail) {
  if (handler_) {
    handler_({.kind = kind,
              .topic = topic_,
              .from_writer = from_writer_,
              .count = count,
              .detail = std::move(detail)});
  }
}

void FastEvents::Matched(std::int32_t change, std::int32_t now) {
  matched_ = now;
  if (change != 0) {
    Raise(change > 0 ? BusEventKind::kMatched : BusEventKind::kUnmatched, now);
  }
}

void FastEvents::IncompatibleQos(std::int64_t more, std::string_view policy) {
  incompatible_qos_ += static_cast<std::uint64_t>(more);
  Raise(BusEventKind::kIncompatibleQos, more, std::string(policy));
}

void FastEvents::Lost(std::int64_t more) {
  lost_ += static_cast<std::uint64_t>(more);
  Raise(BusEventKind::kSampleLost, more);
}

void FastEvents::Rejected(std::int64_t more, std::string_view why) {
  rejected_ += static_cast<std::uint64_t>(more);
  Raise(BusEventKind::kSampleRejected, more, std::string(why));
}

void FastEvents::Malformed(std::string why) {
  ++malformed_;
  Raise(BusEventKind::kMalformed, 1, std::move(why));
}

void FastEvents::Liveliness(std::int32_t alive_change, std::int32_t silent_change,
                            std::int32_t alive) {
  alive_writers_ = alive;
  // A writer that left in good order only lowers `alive`; one that fell silent also joins the
  // silent ones.
  if (silent_change > 0) {
    liveliness_lost_ += static_cast<std::uint64_t>(silent_change);
    Raise(BusEventKind::kLivelinessLost, alive);
  }
  if (alive_change > 0) {
    Raise(BusEventKind::kLivelinessGained, alive);
  }
}

EndpointCounters FastEvents::counters() const {
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

}  // namespace limbcast::bus::fastdds
