#pragma once

#include <atomic>
#include <cstdint>
#include <optional>

#include "common/base/time.hpp"

namespace limbcast::runtime {

/// A one-waiter event on a futex: Set makes the present or the next wait return, once. What
/// happened before Set is seen by the thread whose wait it ended. Set and Close may be called from
/// any number of threads and from a signal handler; the waits from one thread only.
class WakeEvent {
 public:
  /// One atomic exchange; a system call only when the waiter sleeps.
  void Set();

  /// Ends every wait from now on. Cannot be taken back.
  void Close();
  [[nodiscard]] bool closed() const { return state_.load(std::memory_order_acquire) == kClosed; }

  /// A wait would return at once. For a caller that looks before it sleeps.
  [[nodiscard]] bool pending() const {
    const std::uint32_t state = state_.load(std::memory_order_relaxed);
    return state == kSet || state == kClosed;
  }

  /// Sleeps until Set or Close (true) or until the host's CLOCK_REALTIME is at `deadline` (false).
  /// Without a deadline: until Set or Close.
  bool WaitUntil(std::optional<Time> deadline);

  /// The same with a time span, measured by CLOCK_MONOTONIC: does not move when the clock is set.
  bool WaitFor(Duration span);

 private:
  enum : std::uint32_t { kIdle = 0, kSet = 1, kSleeping = 2, kClosed = 3 };
  bool Wait(int clock_flag, std::optional<std::int64_t> deadline_ns);
  bool Consume();

  std::atomic<std::uint32_t> state_{kIdle};
};

}  // namespace limbcast::runtime
