#pragma once

#include <string>

namespace limbcast::bus::cyclone {

/// Takes the library's log off stderr, once for each process: from then on the last warning or
/// error is kept for LastCycloneError and nothing is printed. Thread-safe.
void QuietCycloneLog();

/// What the library complained of last ("" = nothing yet), on one line. Thread-safe.
[[nodiscard]] std::string LastCycloneError();

}  // namespace limbcast::bus::cyclone
