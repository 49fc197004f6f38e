#pragma once

#include <string>

namespace limbcast::bus::fastdds {

/// Takes the library's coloured log off stdout and stderr, once for each process: from then on the
/// last error is kept for LastFastError and nothing is printed. Thread-safe.
void QuietFastLog();

/// What the library complained of last ("" = nothing yet), on one line. Thread-safe.
[[nodiscard]] std::string LastFastError();

}  // namespace limbcast::bus::fastdds
