#include "common/bus/inproc/partition.hpp"

namespace limbcast::bus::inproc {
namespace {

bool IsPattern(std::string_view name) { return name.find_first_of("*?") != std::string_view::npos; }

bool Matches(std::string_view pattern, std::string_view name) {
  // Greedy with one point to come back to: the last '*' and what it has swallowed.
  std::size_t p = 0;
  std::size_t n = 0;
  std::size_t star = std::string_view::npos;
  std::size_t swallowed = 0;
  while (n < name.size()) {
    if (p < pattern.size() && pattern[p] == '*') {
      star = p++;
      swallowed = n;
    } else if (p < pattern.size() && (pattern[p] == '?' || pattern[p] == name[n])) {
      ++p;
      ++n;
    } else if (star != std::string_view::npos) {
      p = star + 1;
      n = ++swallowed;
    } else {
      return false;
    }
  }
  return pattern.find_first_not_of('*', p) == std::string_view::npos;
}

}  // namespace

bool PartitionsMatch(std::string_view a, std::string_view b) {
  if (a == b) {
    return true;
  }
  if (IsPattern(a) == IsPattern(b)) {
    return false;
  }
  return IsPattern(a) ? Matches(a, b) : Matches(b, a);
}

}  // namespace limbcast::bus::inproc
