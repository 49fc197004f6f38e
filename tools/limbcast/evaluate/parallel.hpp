#pragma once

#include <cstddef>
#include <functional>

namespace limbcast::tool {

/// Calls `work(i)` for every i in [0, count), on as many threads as there are cores, and returns
/// when all is done. Calls must not share what they write; so the results do not depend on the
/// number of cores.
void ForEachIndex(std::size_t count, const std::function<void(std::size_t)>& work);

}  // namespace limbcast::tool
