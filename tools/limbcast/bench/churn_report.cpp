#include "tools/limbcast/bench/churn_report.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace limbcast::tool {
namespace {

void Add(std::string& text, const std::string& complaint) {
  text += (text.empty() ? "" : "; ") + complaint;
}

}  // namespace

std::string LeakOf(const ChurnCount& first, const ChurnCount& now, const ChurnLimits& limits) {
  std::string leak;
  for (const auto& [name, is] : now.processes) {
    const auto found = first.processes.find(name);
    const process::ProcessCount was =
        found == first.processes.end() ? process::ProcessCount() : found->second;
    if (is.threads > was.threads) {
      Add(leak, fmt::format("{} has {} threads, had {}", name, is.threads, was.threads));
    }
    if (is.files > was.files) {
      Add(leak, fmt::format("{} has {} open files, had {}", name, is.files, was.files));
    }
    if (is.rss_mib > was.rss_mib + limits.rss_mib) {
      Add(leak, fmt::format("{} holds {:.1f} MiB, held {:.1f}, at most {:.1f} more", name,
                            is.rss_mib, was.rss_mib, limits.rss_mib));
    }
  }
  if (now.shared_memory_files > first.shared_memory_files) {
    Add(leak, fmt::format("{} files in /dev/shm, were {}", now.shared_memory_files,
                          first.shared_memory_files));
  }
  if (!now.people.empty()) {
    Add(leak, fmt::format("still there: {}", fmt::join(now.people, ", ")));
  }
  if (now.all_there_s < 0.0) {
    Add(leak, "not everybody had a skeleton in time");
  }
  return leak;
}

std::string ChurnHeading() {
  return fmt::format("{:>7} {:>9} | {:^21} | {:^21} | {:^21} | {:^21} | {:>4} {:>6}\n", "time",
                     "all there", "session", "fusion", "posture", "client", "shm", "people") +
         fmt::format("{:>7} {:>9} |{:^23}|{:^23}|{:^23}|{:^23}|\n", "s", "s", "threads files MiB",
                     "threads files MiB", "threads files MiB", "threads files MiB");
}

std::string ChurnRow(const ChurnCount& first, const ChurnCount& now, const ChurnLimits& limits) {
  std::string row = fmt::format("{:>7.0f} {:>9.1f}", now.at_s, now.all_there_s);
  for (const char* name : {"session", "fusion", "posture", "client"}) {
    const auto found = now.processes.find(name);
    const process::ProcessCount is =
        found == now.processes.end() ? process::ProcessCount() : found->second;
    row += fmt::format(" | {:>6} {:>6} {:>7.1f}", is.threads, is.files, is.rss_mib);
  }
  row += fmt::format(" | {:>4} {:>6}", now.shared_memory_files, now.people.size());
  const std::string leak = LeakOf(first, now, limits);
  return row + (leak.empty() ? "" : "  " + leak) + '\n';
}

nlohmann::json ChurnJson(const std::vector<ChurnCount>& counts, const ChurnEvents& events,
                         const ChurnLimits& limits) {
  nlohmann::json report = {{"joined", events.joined},          {"left", events.left},
                           {"vanished", events.vanished},      {"killed", events.killed},
                           {"spectators", events.spectators},  {"failures", events.failures},
                           {"counts", nlohmann::json::array()}};
  bool ok = counts.size() > 1 && events.failures.empty();
  for (const ChurnCount& count : counts) {
    const std::string leak = LeakOf(counts.front(), count, limits);
    ok = ok && leak.empty();
    nlohmann::json processes;
    for (const auto& [name, is] : count.processes) {
      processes[name] = {
          {"threads", is.threads}, {"open_files", is.files}, {"rss_mib", is.rss_mib}};
    }
    report["counts"].push_back({{"at_s", count.at_s},
                                {"all_there_s", count.all_there_s},
                                {"processes", processes},
                                {"shared_memory_files", count.shared_memory_files},
                                {"people", count.people.size()},
                                {"leak", leak}});
  }
  report["ok"] = ok;
  return report;
}

std::string ChurnText(const nlohmann::json& report) {
  std::string text = fmt::format(
      "{} joined, {} left, {} vanished, {} spectators came and left; killed:",
      report["joined"].get<std::uint64_t>(), report["left"].get<std::uint64_t>(),
      report["vanished"].get<std::uint64_t>(), report["spectators"].get<std::uint64_t>());
  for (const auto& [name, times] : report["killed"].items()) {
    text += fmt::format(" {} {} times", name, times.get<std::uint64_t>());
  }
  text += '\n';
  for (const auto& failure : report["failures"]) {
    text += "failed: " + failure.get<std::string>() + '\n';
  }
  return text + (report["ok"].get<bool>() ? "nothing leaked, nothing failed\n"
                                          : "not all was as it should be\n");
}

}  // namespace limbcast::tool
