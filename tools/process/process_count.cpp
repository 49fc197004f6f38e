#include "tools/process/process_count.hpp"

#include <unistd.h>

#include <fstream>
#include <iterator>
#include <string>
#include <system_error>

namespace limbcast::process {
namespace {

namespace fs = std::filesystem;

constexpr double kBytesPerMib = 1024.0 * 1024.0;

// An entry that vanishes meanwhile does no harm.
template <typename Counts>
std::size_t CountIn(const fs::path& folder, Counts counts) {
  std::error_code error;
  std::size_t count = 0;
  for (auto entry = fs::directory_iterator(folder, error);
       !error && entry != fs::directory_iterator(); entry.increment(error)) {
    count += counts(entry->path()) ? 1U : 0U;
  }
  return count;
}

// A service looks at its own memory and threads once a second: open for a moment, and no leak.
bool StaysOpen(const fs::path& descriptor) {
  std::error_code error;
  const fs::path file = fs::read_symlink(descriptor, error);
  return !error && !file.string().starts_with("/proc/");
}

}  // namespace

std::size_t FilesIn(const fs::path& folder) {
  return CountIn(folder, [](const fs::path& /*entry*/) { return true; });
}

Result<ProcessCount> CountOf(pid_t pid) {
  const fs::path folder = fs::path("/proc") / std::to_string(pid);
  ProcessCount count;
  count.threads = FilesIn(folder / "task");
  count.files = CountIn(folder / "fd", StaysOpen);
  // proc(5): "size resident shared ..." in pages.
  std::ifstream statm(folder / "statm");
  double size_pages = 0.0;
  double resident_pages = 0.0;
  if (count.threads == 0 || !(statm >> size_pages >> resident_pages)) {
    return Error{ErrorCode::kNotFound, "process " + std::to_string(pid) + " is not there"};
  }
  count.rss_mib = resident_pages * static_cast<double>(sysconf(_SC_PAGESIZE)) / kBytesPerMib;
  return count;
}

}  // namespace limbcast::process
