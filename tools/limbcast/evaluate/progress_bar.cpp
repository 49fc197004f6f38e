#include "tools/limbcast/evaluate/progress_bar.hpp"

#include <fmt/format.h>
#include <unistd.h>

namespace limbcast::tool {

void ShowProgress(std::size_t done, std::size_t all, const std::string& what) {
  if (::isatty(STDERR_FILENO) == 0) {
    return;
  }
  constexpr std::size_t kBar = 24;
  const std::size_t filled = all == 0 ? kBar : kBar * done / all;
  fmt::print(stderr, "\r[{:#>{}}{:.>{}}] {}/{} {:<56.56}{}", "", filled, "", kBar - filled, done,
             all, what, done == all ? "\n" : "");
}

}  // namespace limbcast::tool
