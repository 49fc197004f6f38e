#pragma once

#include <filesystem>
#include <string>

#include "common/base/result.hpp"

namespace limbcast::tool {

/// Writes a whole file, and the folders above it. Fails with kUnavailable naming the path.
[[nodiscard]] Status SaveText(const std::filesystem::path& path, const std::string& text);

/// `text` as it stands between HTML tags.
[[nodiscard]] std::string EscapedHtml(const std::string& text);

}  // namespace limbcast::tool
