#pragma once

#include <cstddef>

namespace limbcast::test_support {

/// Calls of operator new since the process started, on any thread. The counter replaces the global
/// operators of the test executable.
[[nodiscard]] std::size_t AllocationCount();

}  // namespace limbcast::test_support
