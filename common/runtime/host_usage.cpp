#include "common/runtime/host_usage.hpp"

#include <unistd.h>

#include <fstream>
#include <sstream>

namespace limbcast::runtime {

Result<HostUsage> ParseHostUsage(const std::string& proc_stat, double ticks_per_s) {
  // "cpu user nice system idle iowait irq softirq steal guest guest_nice"; guests are in user.
  std::istringstream text(proc_stat);
  std::string name;
  double user = 0.0;
  double nice = 0.0;
  double system = 0.0;
  double idle = 0.0;
  double iowait = 0.0;
  double irq = 0.0;
  double softirq = 0.0;
  double steal = 0.0;
  if (!(text >> name >> user >> nice >> system >> idle >> iowait >> irq >> softirq >> steal) ||
      name != "cpu") {
    return Error{ErrorCode::kCorruptData,
                 "/proc/stat must begin with 'cpu' and 8 numbers, begins with '" +
                     proc_stat.substr(0, proc_stat.find('\n')) + "'"};
  }
  return HostUsage{.busy_seconds = (user + nice + system + irq + softirq) / ticks_per_s,
                   .stolen_seconds = steal / ticks_per_s};
}

HostUsage ReadHostUsage() {
  std::ifstream file("/proc/stat");
  std::string line;
  std::getline(file, line);
  const auto usage = ParseHostUsage(line, static_cast<double>(sysconf(_SC_CLK_TCK)));
  return usage ? *usage : HostUsage{};
}

}  // namespace limbcast::runtime
