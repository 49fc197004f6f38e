#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "common/base/time.hpp"

namespace limbcast {

/// One named number of a service, e.g. {"verdict.duplicate", 3}. Counters only grow while the
/// process lives; gauges say so in their name ("gauge.*").
struct NamedValue {
  std::string name;  ///< at most 48 characters
  double value = 0.0;
  bool operator==(const NamedValue&) const = default;
};

/// Quantiles of one latency stage over the last reporting period.
struct LatencyQuantiles {
  std::string stage;  ///< at most 32 characters, e.g. "gateway_to_fusion"
  std::uint64_t count = 0;
  float p50_us = 0.0F;
  float p99_us = 0.0F;
  float max_us = 0.0F;
  bool operator==(const LatencyQuantiles&) const = default;
};

/// What a process says of itself about once a second (topic `health`, key process_uid).
struct ServiceHealth {
  std::uint64_t process_uid = 0;  ///< random for each process start
  std::string role;  ///< "gateway", "fusion", "posture", "client", ... (at most 32 characters)
  std::string host;  ///< at most 64 characters
  std::uint32_t pid = 0;
  Time started_at{};
  Time reported_at{};
  double cpu_seconds = 0.0;                 ///< user + system time of the process so far
  double rss_mib = 0.0;                     ///< resident memory now
  std::vector<NamedValue> values;           ///< at most 96
  std::vector<LatencyQuantiles> latencies;  ///< at most 16
  std::string last_error;                   ///< empty when all is well; at most 255 characters
  bool operator==(const ServiceHealth&) const = default;
};

}  // namespace limbcast
