#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "common/base/result.hpp"

namespace limbcast::tool {

/// What `--data` means: a recording itself, or all of a folder (.hdf5, .h5, .csv), sorted by name.
/// Fails with kNotFound for a folder without any.
[[nodiscard]] Result<std::vector<std::filesystem::path>> RecordingsIn(const std::string& data);

}  // namespace limbcast::tool
