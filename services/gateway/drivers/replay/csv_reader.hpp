#pragma once

#include <string>
#include <string_view>

#include "common/base/result.hpp"
#include "services/gateway/drivers/replay/recording.hpp"

namespace limbcast::gateway {

/// Reads the CSV layout of CSV.md from `text`; `source` (a path) stands in front of messages,
/// `name` in front of serial numbers. Refuses, with line and column: unknown columns, units other
/// than those of the layout, cells that are no number, incomplete vectors, unknown segments.
/// Readings that are not finite, and rows out of order, are kept for the fusion service to judge.
[[nodiscard]] Result<Recording> ReadCsv(std::string_view text, const std::string& source,
                                        const std::string& name, const RecordingOptions& options);

}  // namespace limbcast::gateway
