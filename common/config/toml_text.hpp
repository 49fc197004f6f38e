#pragma once

#include <cstdint>
#include <string>
#include <string_view>

#include "common/config/config_file.hpp"

/// What a service writes into a TOML file of its own and reads back.
namespace limbcast::config {

/// Text in quotes as TOML has it. Control characters, which no name or serial has, become '?'.
[[nodiscard]] std::string Quoted(std::string_view text);

/// A number that is written as exactly 16 hexadecimal digits in quotes (TOML's own numbers have a
/// sign). Anything else is remembered in the section's file, and what could be read is given.
[[nodiscard]] std::uint64_t ReadHex64(const Section& section, std::string_view key);

}  // namespace limbcast::config
