#pragma once

#include <filesystem>
#include <string>
#include <string_view>

#include "common/base/result.hpp"

namespace limbcast::config {

/// Writes a whole file and waits until it is on the disk: what is renamed into place afterwards
/// survives a loss of power. Fails with kUnavailable naming the file and the reason; what is left
/// of the file then is anything.
[[nodiscard]] Status WriteDurably(const std::filesystem::path& path, const std::string& text);

/// Replaces a file as a whole: writes `<path>.new` durably and renames it into place, so that a
/// crash leaves the old or the new one. With `keep_as`, what was there is copied to that name
/// first. Fails with kUnavailable naming the file and the reason; the old file is untouched then.
[[nodiscard]] Status ReplaceDurably(const std::filesystem::path& path, const std::string& text,
                                    const std::filesystem::path& keep_as = {});

/// Makes the folder that a setting names, if need be. Fails with kUnavailable naming setting,
/// folder and reason when it is none that can be written to.
[[nodiscard]] Status PrepareFolder(const std::filesystem::path& folder, std::string_view setting);

}  // namespace limbcast::config
