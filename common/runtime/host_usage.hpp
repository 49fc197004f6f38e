#pragma once

#include <string>

#include "common/base/result.hpp"

namespace limbcast::runtime {

/// CPU time of all cores of this host since it started, or between two readings.
struct HostUsage {
  double busy_seconds = 0.0;    ///< somebody ran, the kernel included
  double stolen_seconds = 0.0;  ///< this machine wanted to run and its own host did not let it
  friend HostUsage operator-(const HostUsage& later, const HostUsage& earlier) {
    return {later.busy_seconds - earlier.busy_seconds,
            later.stolen_seconds - earlier.stolen_seconds};
  }
};

/// From the text of /proc/stat (proc(5)) with `ticks_per_s`. Fails with kCorruptData.
[[nodiscard]] Result<HostUsage> ParseHostUsage(const std::string& proc_stat, double ticks_per_s);

/// Of this host now. Zeros when it cannot be read.
[[nodiscard]] HostUsage ReadHostUsage();

}  // namespace limbcast::runtime
