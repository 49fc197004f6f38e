#pragma once

#include <cstddef>
#include <string>

namespace limbcast::tool {

/// One line on stderr that overwrites itself; nothing when stderr is no terminal. `done == all`
/// ends it.
void ShowProgress(std::size_t done, std::size_t all, const std::string& what);

}  // namespace limbcast::tool
