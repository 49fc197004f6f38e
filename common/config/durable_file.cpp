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

Status ReplaceDurably(const std::filesystem::path& path, const std::string& text,
                      const std::filesystem::path& keep_as) {
  namespace fs = std::filesystem;
  const auto fail = [&](const char* what, const fs::path& file, const std::error_code& error) {
    return Error{ErrorCode::kUnavailable,
                 std::string(what) + " " + file.string() + ": " + error.message()};
  };
  const fs::path fresh = path.string() + ".new";
  if (Status written = WriteDurably(fresh, text); !written) {
    return written;
  }
  std::error_code error;
  // A copy and not a rename: at no time is there no file under the name itself.
  if (!keep_as.empty() && fs::exists(path, error) &&
      !fs::copy_file(path, keep_as, fs::copy_options::overwrite_existing, error)) {
    return fail("copy to", keep_as, error);
  }
  fs::rename(fresh, path, error);
  return error ? fail("rename to", path, error) : Ok();
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
