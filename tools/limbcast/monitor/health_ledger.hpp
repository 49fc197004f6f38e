#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "common/base/health.hpp"
#include "common/base/time.hpp"

namespace limbcast::tool {

/// The last ServiceHealth of every process that ever reported. Counters of a process that was
/// restarted add up: the new process has another process_uid, and what the old one said last stays.
/// Thread-compatible.
class HealthLedger {
 public:
  void Add(const ServiceHealth& health);

  /// Sum of one counter over all processes of a role, past and present.
  [[nodiscard]] double Sum(std::string_view role, std::string_view name) const;

  /// The same for all counters that begin with `prefix`, by the rest of their names.
  [[nodiscard]] std::map<std::string, double> SumByName(std::string_view role,
                                                        std::string_view prefix) const;

  /// True when process `pid` reported at or after `when`.
  [[nodiscard]] bool HasReported(std::uint32_t pid, Time when) const;

  /// True when a process of that role has reported.
  [[nodiscard]] bool HasRole(std::string_view role) const;

  /// CPU time by role since Mark (or since the first report of processes that came later), in
  /// seconds, and the time span that it was spent in.
  struct Cpu {
    double cpu_seconds = 0.0;
    double span_s = 0.0;
  };
  void Mark();
  [[nodiscard]] std::map<std::string, Cpu> CpuByRole() const;

  /// Last reports, by role, then start.
  [[nodiscard]] std::vector<ServiceHealth> Processes() const;

 private:
  struct Entry {
    ServiceHealth last;
    double marked_cpu_seconds = 0.0;
    Time marked_at{};
  };
  std::map<std::uint64_t, Entry> by_uid_;
};

}  // namespace limbcast::tool
