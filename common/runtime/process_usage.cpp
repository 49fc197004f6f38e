#include "common/runtime/process_usage.hpp"

#include <sys/resource.h>
#include <unistd.h>

#include <fstream>
#include <string>

namespace limbcast::runtime {

ProcessUsage ReadProcessUsage() {
  constexpr double kBytesPerMib = 1024.0 * 1024.0;
  ProcessUsage usage;

  rusage used{};
  if (getrusage(RUSAGE_SELF, &used) == 0) {
    const auto seconds = [](const timeval& t) {
      return static_cast<double>(t.tv_sec) + 1e-6 * static_cast<double>(t.tv_usec);
    };
    usage.cpu_seconds = seconds(used.ru_utime) + seconds(used.ru_stime);
  }

  // proc(5): /proc/self/statm is "size resident shared ..." in pages.
  std::ifstream statm("/proc/self/statm");
  double size_pages = 0.0;
  double resident_pages = 0.0;
  if (statm >> size_pages >> resident_pages) {
    usage.rss_mib = resident_pages * static_cast<double>(sysconf(_SC_PAGESIZE)) / kBytesPerMib;
  }

  std::ifstream status("/proc/self/status");
  for (std::string word; status >> word;) {
    if (word == "Threads:") {
      status >> usage.threads;
      break;
    }
  }
  return usage;
}

}  // namespace limbcast::runtime
