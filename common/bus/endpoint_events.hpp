#pragma once

#include <atomic>
#include <cstdint>
#include <memory>
#include <mutex>
#include <string>
#include <string_view>

#include "common/bus/endpoint.hpp"
#include "common/bus/events.hpp"

namespace limbcast::bus {

/// The event handler of one bus, closed when the bus goes: after Close returns it is not called any
/// more, whoever still holds this. Thread-safe; events may be emitted from inside the handler.
class EventSink {
 public:
  explicit EventSink(BusEventHandler handler) : handler_(std::move(handler)) {}
  void Emit(const BusEvent& event);
  void Close();

 private:
  std::recursive_mutex mutex_;
  BusEventHandler handler_;
};

/// Counts what happens to one reader or writer and tells the bus' event handler. Thread-safe.
class EndpointEvents {
 public:
  EndpointEvents(std::string_view topic, bool from_writer, std::shared_ptr<EventSink> sink)
      : topic_(topic), from_writer_(from_writer), sink_(std::move(sink)) {}

  void Sample() { samples_.fetch_add(1, std::memory_order_relaxed); }
  void Disposed() { disposed_.fetch_add(1, std::memory_order_relaxed); }
  /// `change` > 0: peers came; < 0: they went; `now` are there.
  void Matched(std::int32_t change, std::int32_t now);
  void IncompatibleQos(std::int64_t more, std::string_view policy);
  void Lost(std::int64_t more);
  void Rejected(std::int64_t more, std::string_view why);
  void Malformed(std::string_view why);
  /// How many writers are alive and how many silent now: one that left in good order only lowers
  /// `alive`, one that fell silent also joins the silent ones. What changed is found here, not
  /// taken from a DDS status: a library adds up changes while a listener is inside a call, and a
  /// return that meets the report of its own silence then cancels to no change at all.
  void Liveliness(std::int32_t alive, std::int32_t silent);

  [[nodiscard]] EndpointCounters counters() const;

 private:
  void Emit(BusEventKind kind, std::int64_t count, std::string_view detail = {});

  const std::string_view topic_;
  const bool from_writer_;
  const std::shared_ptr<EventSink> sink_;
  std::atomic<std::uint64_t> samples_{0};
  std::atomic<std::int32_t> matched_{0};
  std::atomic<std::int32_t> alive_writers_{0};
  std::atomic<std::int32_t> silent_writers_{0};
  std::atomic<std::uint64_t> incompatible_qos_{0};
  std::atomic<std::uint64_t> lost_{0};
  std::atomic<std::uint64_t> rejected_{0};
  std::atomic<std::uint64_t> malformed_{0};
  std::atomic<std::uint64_t> liveliness_lost_{0};
  std::atomic<std::uint64_t> disposed_{0};
};

}  // namespace limbcast::bus
