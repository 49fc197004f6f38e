#pragma once

#include <source_location>
#include <string_view>

namespace limbcast {

/// Aborts with the place and `what` on stderr when `condition` is false. For our own mistakes only:
/// what the world refuses is a `Result`, what a sensor sends wrong is a `SampleVerdict`.
void Expects(bool condition, std::string_view what,
             std::source_location where = std::source_location::current());

}  // namespace limbcast
