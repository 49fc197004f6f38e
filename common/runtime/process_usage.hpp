#pragma once

#include <cstdint>

namespace limbcast::runtime {

/// What this process has used so far, as the kernel counts it.
struct ProcessUsage {
  double cpu_seconds = 0.0;  ///< user + system, all threads
  double rss_mib = 0.0;      ///< resident memory now
  std::uint32_t threads = 0;
};

/// Reads it from the kernel (some 20 µs). Fields that cannot be read are 0.
[[nodiscard]] ProcessUsage ReadProcessUsage();

}  // namespace limbcast::runtime
