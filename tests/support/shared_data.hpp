#pragma once

#include <filesystem>
#include <optional>
#include <string_view>

namespace limbcast::test_support {

/// A file or folder of ../shared (e.g. "data/broad"), or nothing when it is not there. Tests that
/// get nothing call LIMBCAST_SKIP_WITHOUT_SHARED, so that the reason is printed.
[[nodiscard]] std::optional<std::filesystem::path> SharedPath(std::string_view relative);

}  // namespace limbcast::test_support

/// Skips the test with "skipped: no ../shared/<relative>" when it is not there.
#define LIMBCAST_SKIP_WITHOUT_SHARED(relative)                       \
  if (!::limbcast::test_support::SharedPath(relative).has_value()) { \
    GTEST_SKIP() << "skipped: no ../shared/" << (relative);          \
  }
