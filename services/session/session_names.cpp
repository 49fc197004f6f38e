#include "services/session/session_names.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstddef>

#include "common/base/utf8.hpp"

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

bool IsControl(char32_t character) {
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
  while (!name.empty()) {
    const auto character = TakeCharacter(name);
    if (!character || IsControl(*character)) {
      return Error{ErrorCode::kInvalidArgument,
                   "a person's name must be UTF-8 without control characters"};
    }
  }
  return Ok();
}

}  // namespace limbcast::session
