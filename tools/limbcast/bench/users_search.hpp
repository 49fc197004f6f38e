#pragma once

#include <optional>
#include <utility>
#include <vector>

namespace limbcast::tool {

/// Finds the largest number of people that a host carries: doubles until it does not, then halves
/// the interval. Assumes that who carries n carries fewer.
class UsersSearch {
 public:
  /// From `first` (at least 1) to at most `max` (at least `first`); ends when the number is known
  /// to 1/20 of itself.
  UsersSearch(int first, int max) : next_(first), max_(max) {}

  /// The number to try next; nothing when the search is over.
  [[nodiscard]] std::optional<int> next() const { return next_; }

  /// What became of next().
  void Add(bool held);

  /// The largest number that was carried; 0 when none was.
  [[nodiscard]] int largest() const { return largest_; }

 private:
  std::optional<int> next_;
  int max_;
  int largest_ = 0;
  std::optional<int> smallest_failed_;
};

/// y = offset + slope x by least squares, and how straight it is.
struct StraightLine {
  double offset = 0.0;
  double slope = 0.0;
  /// Largest distance of a point from the line, as a share of the largest y.
  double worst_share = 0.0;
};

/// Through points with at least two different x; nothing for fewer.
[[nodiscard]] std::optional<StraightLine> FitLine(
    const std::vector<std::pair<double, double>>& points);

}  // namespace limbcast::tool
