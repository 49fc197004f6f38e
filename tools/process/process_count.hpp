#pragma once

#include <sys/types.h>

#include <cstddef>
#include <filesystem>

#include "common/base/result.hpp"

namespace limbcast::process {

/// What another process holds now, as the kernel counts it.
struct ProcessCount {
  std::size_t threads = 0;
  std::size_t files = 0;  ///< open file descriptors, without those in /proc that it reads of itself
  double rss_mib = 0.0;   ///< resident memory
  bool operator==(const ProcessCount&) const = default;
};

/// Fails with kNotFound when there is no such process, or not one of ours.
[[nodiscard]] Result<ProcessCount> CountOf(pid_t pid);

/// Files and folders in `folder`; none when it cannot be read. In /dev/shm, what shared-memory
/// transports leave behind.
[[nodiscard]] std::size_t FilesIn(const std::filesystem::path& folder);

}  // namespace limbcast::process
