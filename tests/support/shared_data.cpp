#include "tests/support/shared_data.hpp"

namespace limbcast::test_support {

std::optional<std::filesystem::path> SharedPath(std::string_view relative) {
  const std::filesystem::path path = std::filesystem::path(LIMBCAST_SHARED_DIR) / relative;
  std::error_code ignored;
  if (!std::filesystem::exists(path, ignored)) {
    return std::nullopt;
  }
  return path;
}

}  // namespace limbcast::test_support
