#pragma once

#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "common/base/result.hpp"
#include "common/filters/filter.hpp"

namespace limbcast::filters {

/// A parameter as configuration and command lines give it, e.g. {"k_per_s", "0.3"}. Keys are the
/// field names of the filter's configuration struct.
using Setting = std::pair<std::string, std::string>;

/// Names that MakeFilter knows.
[[nodiscard]] std::span<const std::string_view> FilterNames();

/// A filter with its shipped defaults changed by `settings`. Fails with kInvalidArgument naming the
/// filter, key or value and what would be allowed.
[[nodiscard]] Result<std::unique_ptr<OrientationFilter>> MakeFilter(
    std::string_view name, std::span<const Setting> settings = {});

}  // namespace limbcast::filters
