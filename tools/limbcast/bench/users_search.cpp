#include "tools/limbcast/bench/users_search.hpp"

#include <algorithm>
#include <cmath>

#include "common/base/expects.hpp"

namespace limbcast::tool {

void UsersSearch::Add(bool held) {
  Expects(next_.has_value(), "a search that is not over");
  if (held) {
    largest_ = *next_;
  } else {
    smallest_failed_ = *next_;
  }
  if (!smallest_failed_) {
    next_ = largest_ < max_ ? std::optional(std::min(2 * largest_, max_)) : std::nullopt;
    return;
  }
  constexpr int kResolution = 20;
  const int gap = *smallest_failed_ - largest_;
  next_ =
      gap > std::max(1, largest_ / kResolution) ? std::optional(largest_ + gap / 2) : std::nullopt;
}

std::optional<StraightLine> FitLine(const std::vector<std::pair<double, double>>& points) {
  double mean_x = 0.0;
  double mean_y = 0.0;
  const auto count = static_cast<double>(points.size());
  for (const auto& [x, y] : points) {
    mean_x += x / count;
    mean_y += y / count;
  }
  double sum_xx = 0.0;
  double sum_xy = 0.0;
  for (const auto& [x, y] : points) {
    sum_xx += (x - mean_x) * (x - mean_x);
    sum_xy += (x - mean_x) * (y - mean_y);
  }
  if (!(sum_xx > 0.0)) {
    return std::nullopt;
  }
  StraightLine line{.offset = mean_y - sum_xy / sum_xx * mean_x, .slope = sum_xy / sum_xx};
  double largest_y = 0.0;
  for (const auto& [x, y] : points) {
    largest_y = std::max(largest_y, std::abs(y));
    line.worst_share = std::max(line.worst_share, std::abs(y - line.offset - line.slope * x));
  }
  line.worst_share = largest_y > 0.0 ? line.worst_share / largest_y : 0.0;
  return line;
}

}  // namespace limbcast::tool
