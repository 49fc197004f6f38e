#pragma once

#include <array>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <mutex>
#include <string>
#include <vector>

#include "common/base/health.hpp"
#include "common/bus/events.hpp"

namespace limbcast::service {

/// Makes what happens to the connections of a process visible: counters in its health and one named
/// line in its log. The handler only notes (middleware threads must not wait for a log); Report,
/// called once a second, writes. Thread-safe; outlives the bus that calls its handler.
class BusEvents {
 public:
  /// For bus::Open.
  [[nodiscard]] bus::BusEventHandler handler() {
    return [this](const bus::BusEvent& event) { Note(event); };
  }

  void Note(const bus::BusEvent& event);

  /// Adds "bus.<kind>" for every kind, and last_error (when that is empty) for an incompatible or
  /// lost peer; logs a line for each event since the last call.
  void Report(ServiceHealth& health);

  [[nodiscard]] std::uint64_t count(bus::BusEventKind kind) const {
    return counts_[static_cast<std::size_t>(kind)].load(std::memory_order_relaxed);
  }

 private:
  static constexpr std::size_t kMaxPending = 64;  // more in one second are only counted

  std::array<std::atomic<std::uint64_t>, bus::kBusEventKindCount> counts_{};
  std::mutex mutex_;  // guards the three below; never held while logging
  std::vector<bus::BusEvent> pending_;
  std::uint64_t not_logged_ = 0;
  std::string last_error_;
};

/// "liveliness_lost on marg (reader, now 0)": what the log line says.
[[nodiscard]] std::string Describe(const bus::BusEvent& event);

}  // namespace limbcast::service
