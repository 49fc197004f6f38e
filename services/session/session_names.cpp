#include "services/session/session_names.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>

namespace limbcast::session {
namespace {

constexpr std::size_t kMaxLength = 64;  // bound of the wire types

Status CheckLength(const char* whose, std::string_view name) {
  if (name.empty() || name.size() > kMaxLength) {
    return Error{
        ErrorCode::kInvalidArgument,
        fmt::format("a {} name must have 1 to {} bytes, has {}", whose, kMaxLength, name.size())};
  }
  return Ok();
}

bool IsPlain(char c) {
  return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '.' ||
         c == '_' || c == '-';
}

// Takes one character off the front, by Table 3-7 of the Unicode standard (no overlong forms, no
// surrogates, nothing above U+10FFFF); false when the bytes are none.
bool TakeCharacter(std::string_view& text, std::uint32_t& character) {
  const auto byte = [&](std::size_t i) { return static_cast<std::uint8_t>(text[i]); };
  const std::uint8_t lead = byte(0);
  const std::size_t length = lead < 0x80U                     ? 1
                             : lead >= 0xC2U && lead <= 0xDFU ? 2
                             : lead >= 0xE0U && lead <= 0xEFU ? 3
                             : lead >= 0xF0U && lead <= 0xF4U ? 4
                                                              : 0;
  if (length == 0 || text.size() < length) {
    return false;
  }
  character = length == 1 ? lead : lead & (0x7FU >> length);
  for (std::size_t i = 1; i < length; ++i) {
    if ((byte(i) & 0xC0U) != 0x80U) {
      return false;
    }
    character = (character << 6U) | (byte(i) & 0x3FU);
  }
  text.remove_prefix(length);
  return !(length == 3 && character < 0x800U) && !(length == 4 && character < 0x10000U) &&
         !(character >= 0xD800U && character <= 0xDFFFU) && character <= 0x10FFFFU;
}

bool IsControl(std::uint32_t character) {
  return character < 0x20U || (character >= 0x7FU && character < 0xA0U);
}

}  // namespace

Status ValidateSessionName(std::string_view name) {
  if (Status length = CheckLength("session's", name); !length) {
    return length;
  }
  if (!std::all_of(name.begin(), name.end(), IsPlain)) {
    return Error{ErrorCode::kInvalidArgument,
                 "a session's name must be of the characters A-Z a-z 0-9 . _ -"};
  }
  return Ok();
}

Status ValidatePersonName(std::string_view name) {
  if (Status length = CheckLength("person's", name); !length) {
    return length;
  }
  std::uint32_t character = 0;
  while (!name.empty()) {
    if (!TakeCharacter(name, character) || IsControl(character)) {
      return Error{ErrorCode::kInvalidArgument,
                   "a person's name must be UTF-8 without control characters"};
    }
  }
  return Ok();
}

}  // namespace limbcast::session
