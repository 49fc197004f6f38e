#pragma once

#include <filesystem>
#include <string>

#include "common/base/result.hpp"

namespace limbcast::config {

/// Writes a whole file and waits until it is on the disk: what is renamed into place afterwards
/// survives a loss of power. Fails with kUnavailable naming the file and the reason; what is left
/// of the file then is anything.
[[nodiscard]] Status WriteDurably(const std::filesystem::path& path, const std::string& text);

}  // namespace limbcast::config
