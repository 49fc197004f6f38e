#pragma once

#include <ctime>

#include "common/base/time.hpp"

namespace limbcast::bus {

/// CLOCK_REALTIME, for SampleInfo::received_at only.
[[nodiscard]] inline Time SystemNow() {
  timespec now{};
  clock_gettime(CLOCK_REALTIME, &now);
  return TimeFromNanoseconds(static_cast<std::int64_t>(now.tv_sec) * 1'000'000'000 + now.tv_nsec);
}

}  // namespace limbcast::bus
