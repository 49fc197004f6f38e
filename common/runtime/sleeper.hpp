#pragma once

#include "common/base/time.hpp"
#include "common/runtime/wake_event.hpp"

namespace limbcast::runtime {

/// Absolute-deadline sleep that another thread can end: the pacing of drivers and replay. One
/// sleeping thread, any number of threads that stop it.
///
///   while (sleeper.Until(next)) { Emit(); next += period; }
class Sleeper {
 public:
  /// True at `deadline` (host's CLOCK_REALTIME); false, at once, when stopped.
  [[nodiscard]] bool Until(Time deadline);

  /// True after `span` (CLOCK_MONOTONIC); false, at once, when stopped.
  [[nodiscard]] bool For(Duration span);

  /// Ends the present sleep and all later ones.
  void Stop() { event_.Close(); }
  [[nodiscard]] bool stopped() const { return event_.closed(); }

 private:
  WakeEvent event_;
};

}  // namespace limbcast::runtime
