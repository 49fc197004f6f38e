#pragma once

#include <optional>
#include <string_view>

namespace limbcast {

/// Takes one character off the front of `text`, which must not be empty, by Table 3-7 of the
/// Unicode standard (no overlong forms, no surrogates, nothing above U+10FFFF). Nothing, and `text`
/// as it was, when its first bytes are none.
[[nodiscard]] std::optional<char32_t> TakeCharacter(std::string_view& text);

}  // namespace limbcast
