#include "common/config/toml_ascii.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <iterator>
#include <optional>
#include <utility>

#include "common/base/expects.hpp"
#include "common/base/utf8.hpp"

namespace limbcast::config::internal {
namespace {

constexpr std::string_view kByteOrderMark = "\xEF\xBB\xBF";

bool IsAscii(char c) { return static_cast<unsigned char>(c) < 0x80; }

bool IsAsciiText(std::string_view text) { return std::ranges::all_of(text, IsAscii); }

Error ErrorAt(std::string_view text, std::size_t at, const std::string& name,
              std::string_view what) {
  return {ErrorCode::kInvalidArgument,
          fmt::format("{}:{}: {}", name, 1 + std::ranges::count(text.substr(0, at), '\n'), what)};
}

std::optional<Error> FindNoUtf8(std::string_view text, const std::string& name) {
  std::string_view rest = text;
  while (!rest.empty()) {
    if (!TakeCharacter(rest)) {
      const auto byte = static_cast<unsigned char>(rest.front());
      return ErrorAt(text, text.size() - rest.size(), name,
                     fmt::format("byte 0x{:02x} is no UTF-8", byte));
    }
  }
  return std::nullopt;
}

struct QuotedString {
  std::string_view delimiter;  // one quote or three
  std::string_view content;
  std::string_view end;  // as the delimiter; empty when the line or the text ends before

  [[nodiscard]] std::size_t size() const { return delimiter.size() + content.size() + end.size(); }
};

// The string that begins at text[at]. One quote or two more before the last three are content.
QuotedString StringAt(std::string_view text, std::size_t at) {
  const std::string three(3, text[at]);
  const bool lines = text.substr(at, 3) == three;
  const bool escapes = text[at] == '"';
  const std::string_view delimiter = text.substr(at, lines ? 3 : 1);
  const std::size_t begin = at + delimiter.size();
  const auto ends_at = [&](std::size_t i) { return text.substr(i, delimiter.size()) == delimiter; };
  std::size_t end = begin;
  while (end < text.size() && !ends_at(end) && (lines || text[end] != '\n')) {
    end += escapes && text[end] == '\\' ? 2U : 1U;
  }
  end = std::min(end, text.size());
  const bool closed = ends_at(end);
  for (int more = 0; closed && lines && more < 2 && ends_at(end + 1); ++more) {
    ++end;
  }
  return {.delimiter = delimiter,
          .content = text.substr(begin, end - begin),
          .end = text.substr(end, closed ? delimiter.size() : 0)};
}

// In double quotes, by toml.io/en/v1.0.0#string.
std::string Escaped(const QuotedString& string) {
  const bool literal = string.delimiter.front() == '\'';
  std::string escaped(string.delimiter.size(), '"');
  bool after_backslash = false;
  std::string_view rest = string.content;
  while (!rest.empty()) {
    const auto taken = TakeCharacter(rest);
    Expects(taken.has_value(), "the whole text is UTF-8");
    const char32_t character = *taken;
    if (character >= 0x80U && after_backslash) {
      escaped += '_';  // no escape of TOML either: the parser says so
    } else if (character >= 0x80U) {
      fmt::format_to(std::back_inserter(escaped), "\\U{:08X}",
                     static_cast<std::uint32_t>(character));
    } else {
      if (literal && (character == U'"' || character == U'\\')) {
        escaped += '\\';
      }
      escaped += static_cast<char>(character);
    }
    after_backslash = !literal && !after_backslash && character == U'\\';
  }
  return escaped.append(string.end.size(), '"');
}

}  // namespace

Result<std::string> AsciiToml(std::string_view text, const std::string& name) {
  if (IsAsciiText(text)) {
    return std::string(text);
  }
  if (auto error = FindNoUtf8(text, name)) {
    return std::move(*error);
  }
  std::string ascii;
  std::size_t at = text.starts_with(kByteOrderMark) ? kByteOrderMark.size() : 0;
  while (at < text.size()) {
    if (text[at] == '"' || text[at] == '\'') {
      const QuotedString string = StringAt(text, at);
      const std::string_view whole = text.substr(at, string.size());
      ascii += IsAsciiText(whole) ? std::string(whole) : Escaped(string);
      at += whole.size();
    } else if (text[at] == '#') {
      at = std::min(text.find('\n', at), text.size());
    } else if (!IsAscii(text[at])) {
      const std::string_view rest = text.substr(at);
      const std::string_view letters(rest.begin(), std::ranges::find_if(rest, IsAscii));
      return ErrorAt(text, at, name,
                     fmt::format("'{}' outside of quotes, TOML allows ASCII only there", letters));
    } else {
      ascii += text[at++];
    }
  }
  return ascii;
}

}  // namespace limbcast::config::internal
