#include "common/config/toml_text.hpp"

#include <fmt/format.h>

#include <charconv>

namespace limbcast::config {

std::string Quoted(std::string_view text) {
  std::string quoted = "\"";
  for (const char c : text) {
    quoted += c == '"' || c == '\\' ? "\\" : "";
    quoted += static_cast<unsigned char>(c) < 0x20 ? '?' : c;
  }
  return quoted + '"';
}

std::uint64_t ReadHex64(const Section& section, std::string_view key) {
  const std::string text = section.Read(key, "", 16);
  std::uint64_t value = 0;
  const auto parsed = std::from_chars(text.data(), text.data() + text.size(), value, 16);
  if (text.size() != 16 || parsed.ptr != text.data() + text.size()) {
    section.Fail(key, fmt::format("must be 16 hexadecimal digits, is \"{}\"", text));
  }
  return value;
}

}  // namespace limbcast::config
