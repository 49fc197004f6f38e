#include "tools/limbcast/doctor/host_facts.hpp"

#include <algorithm>
#include <fstream>
#include <iterator>
#include <set>
#include <system_error>

#include "tools/limbcast/demo/free_domain.hpp"

namespace limbcast::tool {
namespace {

namespace fs = std::filesystem;

constexpr std::uint32_t kNumbers = 120;

bool IsOfFastDds(const std::string& name) {
  return name.starts_with("fastrtps_") || name.starts_with("sem.fastrtps_");
}

// The name below `folder` of what a process has open or mapped; empty for anything else.
std::string NameBelow(const std::string& path, const std::string& folder) {
  return path.starts_with(folder + '/') ? path.substr(folder.size() + 1) : std::string();
}

void AddOpenFiles(const fs::path& process, const std::string& folder, std::set<std::string>& open) {
  std::error_code error;
  for (fs::directory_iterator it(process / "fd", error), end; !error && it != end;
       it.increment(error)) {
    std::error_code unreadable;
    open.insert(NameBelow(fs::read_symlink(it->path(), unreadable).string(), folder));
  }
  std::ifstream maps(process / "maps");
  for (std::string line; std::getline(maps, line);) {
    if (const std::size_t at = line.find('/'); at != std::string::npos) {
      open.insert(NameBelow(line.substr(at), folder));
    }
  }
}

}  // namespace

std::size_t CountParticipants(const std::vector<std::uint16_t>& used_ports, std::uint32_t domain) {
  std::size_t count = 0;
  for (std::uint32_t number = 0; number < kNumbers; ++number) {
    const std::uint32_t port = 7400 + 250 * domain + 10 + 2 * number;
    count += std::find(used_ports.begin(), used_ports.end(), port) != used_ports.end() ? 1U : 0U;
  }
  return count;
}

std::size_t CountParticipants(std::uint32_t domain) {
  std::ifstream file("/proc/net/udp");
  const std::string text(std::istreambuf_iterator<char>(file), {});
  return CountParticipants(ParseUdpPorts(text), domain);
}

std::vector<std::string> StaleSharedMemory(const fs::path& shared_memory,
                                           const fs::path& processes) {
  std::vector<std::string> files;
  std::error_code error;
  for (fs::directory_iterator it(shared_memory, error), end; !error && it != end;
       it.increment(error)) {
    if (IsOfFastDds(it->path().filename().string())) {
      files.push_back(it->path().filename().string());
    }
  }
  if (files.empty()) {
    return files;
  }
  std::set<std::string> open;
  for (fs::directory_iterator it(processes, error), end; !error && it != end; it.increment(error)) {
    AddOpenFiles(it->path(), shared_memory.string(), open);
  }
  std::erase_if(files, [&](const std::string& file) { return open.contains(file); });
  std::sort(files.begin(), files.end());
  return files;
}

std::int64_t NumberIn(const fs::path& file) {
  std::int64_t number = 0;
  std::ifstream(file) >> number;
  return number;
}

}  // namespace limbcast::tool
