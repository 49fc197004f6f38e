#pragma once

#include <atomic>
#include <cstdint>
#include <string>
#include <string_view>

#include "common/bus/endpoint.hpp"
#include "common/bus/events.hpp"

namespace limbcast::bus::fastdds {

/// Counts what happens to one reader or writer and tells the bus' event handler. Thread-safe.
class FastEvents {
 public:
  FastEvents(std::string_view topic, bool from_writer, const BusEventHandler& handler)
      : topic_(topic), from_writer_(from_writer), handler_(handler) {}

  void Sample() { samples_.fetch_add(1, std::memory_order_relaxed); }
  void Disposed() { disposed_.fetch_add(1, std::memory_order_relaxed); }
  /// `change` > 0: a peer came; < 0: it went; `now` are there.
  void Matched(std::int32_t change, std::int32_t now);
  void IncompatibleQos(std::int64_t more, std::string_view policy);
  void Lost(std::int64_t more);
  void Rejected(std::int64_t more, std::string_view why);
  void Malformed(std::string why);
  /// `alive_change` and `silent_change` as in the DDS liveliness-changed status; `alive` now.
  void Liveliness(std::int32_t alive_change, std::int32_t silent_change, std::int32_t alive);

  [[nodiscard]] EndpointCounters counters() const;

 private:
  void Raise(BusEventKind kind, std::int64_t count, std::string detail = {});

  std::string_view topic_;
  bool from_writer_;
  const BusEventHandler& handler_;  // of the participant, which outlives its endpoints
  std::atomic<std::uint64_t> samples_ = 0;
  std::atomic<std::int32_t> matched_ = 0;
  std::atomic<std::int32_t> alive_writers_ = 0;
  std::atomic<std::uint64_t> incompatible_qos_ = 0;
  std::atomic<std::uint64_t> lost_ = 0;
  std::atomic<std::uint64_t> rejected_ = 0;
  std::atomic<std::uint64_t> malformed_ = 0;
  std::atomic<std::uint64_t> liveliness_lost_ = 0;
  std::atomic<std::uint64_t> disposed_ = 0;
};

}  // namespace limbcast::bus::fastdds
