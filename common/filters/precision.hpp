#pragma once

#include <array>
#include <cstdint>
#include <string_view>

namespace limbcast::filters {

/// Arithmetic of a filter's core; time, bad input and the start are in double always.
enum class Precision : std::uint8_t { kDouble = 0, kFloat = 1 };

inline constexpr std::array<std::string_view, 2> kPrecisionNames = {"double", "float"};

}  // namespace limbcast::filters
