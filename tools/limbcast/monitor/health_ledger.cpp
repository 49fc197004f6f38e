#include "tools/limbcast/monitor/health_ledger.hpp"

#include <algorithm>
#include <tuple>

namespace limbcast::tool {

void HealthLedger::Add(const ServiceHealth& health) {
  const auto [it, is_new] = by_uid_.try_emplace(health.process_uid);
  Entry& entry = it->second;
  if (is_new) {
    entry.marked_cpu_seconds = health.cpu_seconds;
    entry.marked_at = health.reported_at;
  }
  entry.last = health;
}

double HealthLedger::Sum(std::string_view role, std::string_view name) const {
  double sum = 0.0;
  for (const auto& [uid, entry] : by_uid_) {
    for (const NamedValue& value : entry.last.values) {
      if (entry.last.role == role && value.name == name) {
        sum += value.value;
      }
    }
  }
  return sum;
}

std::map<std::string, double> HealthLedger::SumByName(std::string_view role,
                                                      std::string_view prefix) const {
  std::map<std::string, double> sums;
  for (const auto& [uid, entry] : by_uid_) {
    for (const NamedValue& value : entry.last.values) {
      if (entry.last.role == role && value.name.starts_with(prefix)) {
        sums[value.name.substr(prefix.size())] += value.value;
      }
    }
  }
  return sums;
}

bool HealthLedger::HasReported(std::uint32_t pid, Time when) const {
  return std::any_of(by_uid_.begin(), by_uid_.end(), [&](const auto& item) {
    return item.second.last.pid == pid && item.second.last.reported_at >= when;
  });
}

bool HealthLedger::HasRole(std::string_view role) const {
  return std::any_of(by_uid_.begin(), by_uid_.end(),
                     [&](const auto& item) { return item.second.last.role == role; });
}

void HealthLedger::Mark() {
  for (auto& [uid, entry] : by_uid_) {
    entry.marked_cpu_seconds = entry.last.cpu_seconds;
    entry.marked_at = entry.last.reported_at;
  }
}

std::map<std::string, HealthLedger::Cpu> HealthLedger::CpuByRole() const {
  std::map<std::string, Cpu> result;
  for (const auto& [uid, entry] : by_uid_) {
    Cpu& cpu = result[entry.last.role];
    cpu.cpu_seconds += entry.last.cpu_seconds - entry.marked_cpu_seconds;
    cpu.span_s += ToSeconds(entry.last.reported_at - entry.marked_at);
  }
  return result;
}

std::vector<ServiceHealth> HealthLedger::Processes() const {
  std::vector<ServiceHealth> all;
  all.reserve(by_uid_.size());
  for (const auto& [uid, entry] : by_uid_) {
    all.push_back(entry.last);
  }
  std::sort(all.begin(), all.end(), [](const ServiceHealth& a, const ServiceHealth& b) {
    return std::tie(a.role, a.started_at, a.process_uid) <
           std::tie(b.role, b.started_at, b.process_uid);
  });
  return all;
}

}  // namespace limbcast::tool
