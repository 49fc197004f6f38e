#pragma once

#include <atomic>
#include <cstdint>
#include <functional>
#include <string>

#include "common/base/time.hpp"
#include "common/runtime/named_thread.hpp"
#include "common/runtime/sleeper.hpp"

namespace limbcast::runtime {

/// Calls `tick` once in each period on a thread of its own, first one period after construction.
/// Deadlines are absolute (no drift) on CLOCK_MONOTONIC (setting the clock does not disturb them);
/// a tick that takes longer than the period makes the ones it covered be left out, and counted.
class PeriodicThread {
 public:
  /// `period` > 0.
  PeriodicThread(std::string name, Duration period, std::function<void()> tick);
  ~PeriodicThread() { Stop(); }
  PeriodicThread(const PeriodicThread&) = delete;
  PeriodicThread& operator=(const PeriodicThread&) = delete;

  /// No tick runs after it returns. Does not wait for the rest of the period. Idempotent.
  void Stop();

  [[nodiscard]] std::uint64_t ticks() const { return ticks_.load(); }
  [[nodiscard]] std::uint64_t missed_ticks() const { return missed_ticks_.load(); }

 private:
  void Run();

  const Duration period_;
  const std::function<void()> tick_;
  std::atomic<std::uint64_t> ticks_{0};
  std::atomic<std::uint64_t> missed_ticks_{0};
  Sleeper sleeper_;
  NamedThread thread_;  // last: starts when the rest is there
};

}  // namespace limbcast::runtime
