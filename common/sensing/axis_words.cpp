#include "common/sensing/axis_words.hpp"

#include <array>
#include <charconv>
#include <cmath>

namespace limbcast::sensing {

std::string DirectionWords(const Eigen::Vector3d& direction) {
  constexpr double kNamedFrom = 0.4;  // the largest part of a unit vector is at least 0.577
  constexpr std::array<char, 3> kAxes = {'x', 'y', 'z'};
  const Eigen::Vector3d unit = direction.normalized();
  std::string words;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const double part = unit(static_cast<Eigen::Index>(axis));
    if (std::abs(part) >= kNamedFrom) {
      words += part > 0.0 ? '+' : '-';
      words += kAxes[axis];
    }
  }
  return words;
}

std::string NumberText(double value, int decimals) {
  std::array<char, 64> text{};
  const auto [end, error] = std::to_chars(text.data(), text.data() + text.size(), value,
                                          std::chars_format::fixed, decimals);
  return error == std::errc{} ? std::string(text.data(), end) : std::string("out of range");
}

std::string PercentText(double share, int decimals) {
  return NumberText(100.0 * share, decimals) + " %";
}

}  // namespace limbcast::sensing
