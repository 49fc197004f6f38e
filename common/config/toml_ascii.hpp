#pragma once

#include <string>
#include <string_view>

#include "common/base/result.hpp"

namespace limbcast::config::internal {

/// The same TOML document in ASCII alone, on the same lines: a string with other letters becomes
/// one in double quotes with escapes, comments go. toml++ 3.3 takes some letters for white space or
/// the beginning of a key where it expects those, and then calls it unreachable that they are none
/// (tests/fuzz). Fails with kInvalidArgument naming the line of `name` for letters above ASCII
/// outside of quotes and comments, where TOML has none, and for bytes that are no UTF-8. What is
/// wrong otherwise is left to the parser. See toml.io/en/v1.0.0.
[[nodiscard]] Result<std::string> AsciiToml(std::string_view text, const std::string& name);

}  // namespace limbcast::config::internal
