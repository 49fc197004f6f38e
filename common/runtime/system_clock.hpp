#pragma once

#include "common/base/clock.hpp"

namespace limbcast::runtime {

/// The host's CLOCK_REALTIME: the time scale of every sample (hosts are kept in step by PTP or
/// NTP). It can step when an administrator sets it. Thread-safe.
class SystemClock final : public Clock {
 public:
  [[nodiscard]] Time Now() const override;
};

}  // namespace limbcast::runtime
