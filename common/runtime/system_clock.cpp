#include "common/runtime/system_clock.hpp"

#include <ctime>

namespace limbcast::runtime {

Time SystemClock::Now() const {
  timespec now{};
  clock_gettime(CLOCK_REALTIME, &now);
  return TimeFromNanoseconds(static_cast<std::int64_t>(now.tv_sec) * 1'000'000'000 + now.tv_nsec);
}

}  // namespace limbcast::runtime
