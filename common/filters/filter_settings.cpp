#include "common/filters/filter_settings.hpp"

#include <cmath>

namespace limbcast::filters::internal {

std::string NumberText(double value) {
  if (!std::isfinite(value)) {
    return std::isnan(value) ? "nan" : (value < 0.0 ? "-inf" : "inf");
  }
  std::array<char, 32> buffer{};
  const auto [end, error] = std::to_chars(buffer.data(), buffer.data() + buffer.size(), value);
  return error == std::errc() ? std::string(buffer.data(), end) : std::string("?");
}

std::string RangeText(double min, double max, bool min_excluded, bool whole) {
  return std::string(whole ? "a whole number in " : "in ") + (min_excluded ? "(" : "[") +
         NumberText(min) + ", " + NumberText(max) + "]";
}

std::string ChoicesText(std::span<const std::string_view> choices) {
  std::string text;
  for (std::size_t i = 0; i < choices.size(); ++i) {
    text += i == 0 ? "" : (i + 1 == choices.size() ? " or " : ", ");
    text += choices[i];
  }
  return text;
}

}  // namespace limbcast::filters::internal
