#pragma once

#include <csignal>
#include <cstdint>

#include "common/base/time.hpp"

namespace limbcast::runtime {

/// Turns SIGINT and SIGTERM into "please stop" while it lives; main() makes one, first of all, and
/// waits on it. The signal handler touches only an atomic of static storage and a futex, so there
/// is nothing that the destructor could take away under it. Thread-safe; any number of threads may
/// wait. One object at a time.
class StopSignal {
 public:
  StopSignal();
  ~StopSignal();
  StopSignal(const StopSignal&) = delete;
  StopSignal& operator=(const StopSignal&) = delete;

  /// Returns when a signal came or Trigger was called.
  void Wait() const;

  /// The same, but at most for `span`. True when asked to stop.
  bool WaitFor(Duration span) const;

  [[nodiscard]] bool Requested() const;

  /// The same as a signal: for tests, and for a service that decides to end by itself.
  void Trigger();

 private:
  std::uint32_t requests_before_;
  struct sigaction previous_interrupt_ {};
  struct sigaction previous_terminate_ {};
};

}  // namespace limbcast::runtime
