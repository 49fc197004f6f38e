#include "common/config/durable_file.hpp"

#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
#include <cstddef>
#include <system_error>

namespace limbcast::config {

Status WriteDurably(const std::filesystem::path& path, const std::string& text) {
  const auto fail = [&](const char* what) {
    return Error{ErrorCode::kUnavailable, std::string(what) + " " + path.string() + ": " +
                                              std::generic_category().message(errno)};
  };
  const int file = ::open(path.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0644);
  if (file < 0) {
    return fail("open");
  }
  Status status = Ok();
  std::size_t written = 0;
  while (status.ok() && written < text.size()) {
    const ssize_t n = ::write(file, text.data() + written, text.size() - written);
    if (n < 0 && errno == EINTR) {
      continue;
    }
    if (n < 0) {
      status = fail("write");
    } else {
      written += static_cast<std::size_t>(n);
    }
  }
  if (status.ok() && ::fsync(file) != 0) {
    status = fail("sync");
  }
  ::close(file);
  return status;
}

Status PrepareFolder(const std::filesystem::path& folder, std::string_view setting) {
  std::error_code error;
  std::filesystem::create_directories(folder, error);
  if (!std::filesystem::is_directory(folder) || ::access(folder.c_str(), W_OK | X_OK) != 0) {
    return Error{ErrorCode::kUnavailable,
                 std::string(setting) + " must be a writable folder, is \"" + folder.string() +
                     "\" (" + (error ? error.message() : std::generic_category().message(errno)) +
                     ")"};
  }
  return Ok();
}

}  // namespace limbcast::config
