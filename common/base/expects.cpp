#include "common/base/expects.hpp"

#include <cstdio>
#include <cstdlib>

namespace limbcast {

void Expects(bool condition, std::string_view what, std::source_location where) {
  if (condition) [[likely]] {
    return;
  }
  std::fprintf(stderr, "%s:%u: %s: expected %.*s\n", where.file_name(), where.line(),
               where.function_name(), static_cast<int>(what.size()), what.data());
  std::abort();
}

}  // namespace limbcast
