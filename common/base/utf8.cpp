#include "common/base/utf8.hpp"

#include <cstddef>
#include <cstdint>

namespace limbcast {

std::optional<char32_t> TakeCharacter(std::string_view& text) {
  const auto byte = [&](std::size_t i) { return static_cast<std::uint8_t>(text[i]); };
  const std::uint8_t lead = byte(0);
  const std::size_t length = lead < 0x80U                     ? 1
                             : lead >= 0xC2U && lead <= 0xDFU ? 2
                             : lead >= 0xE0U && lead <= 0xEFU ? 3
                             : lead >= 0xF0U && lead <= 0xF4U ? 4
                                                              : 0;
  if (length == 0 || text.size() < length) {
    return std::nullopt;
  }
  char32_t character = length == 1 ? lead : lead & (0x7FU >> length);
  for (std::size_t i = 1; i < length; ++i) {
    if ((byte(i) & 0xC0U) != 0x80U) {
      return std::nullopt;
    }
    character = (character << 6U) | (byte(i) & 0x3FU);
  }
  if ((length == 3 && character < 0x800U) || (length == 4 && character < 0x10000U) ||
      (character >= 0xD800U && character <= 0xDFFFU) || character > 0x10FFFFU) {
    return std::nullopt;
  }
  text.remove_prefix(length);
  return character;
}

}  // namespace limbcast
