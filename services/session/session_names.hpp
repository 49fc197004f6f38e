#pragma once

#include <string_view>

#include "common/base/result.hpp"

namespace limbcast::session {

/// A session's name is also its DDS partition: 1 to 64 of the characters A-Z a-z 0-9 . _ -, so that
/// it is no pattern and no list.
[[nodiscard]] Status ValidateSessionName(std::string_view name);

/// A person's name: 1 to 64 bytes of UTF-8 without control characters.
[[nodiscard]] Status ValidatePersonName(std::string_view name);

}  // namespace limbcast::session
