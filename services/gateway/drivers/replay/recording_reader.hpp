#pragma once

#include <filesystem>

#include "common/base/result.hpp"
#include "services/gateway/drivers/replay/recording.hpp"

namespace limbcast::gateway {

/// Reads a recording of any known format, which it tells by the content and not by the name:
/// BROAD HDF5, full-body HDF5, Xsens text exports (one file or a folder of them), CSV (see CSV.md).
/// Assigns segments and flags held magnetometer readings. Refuses a recording without samples.
///
/// kNotFound: nothing at `path`; kUnsupported: not a known format; kCorruptData: a known one that
/// is damaged; kInvalidArgument: `options`.
[[nodiscard]] Result<Recording> ReadRecording(const std::filesystem::path& path,
                                              const RecordingOptions& options = {});

}  // namespace limbcast::gateway
