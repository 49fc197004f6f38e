#pragma once

#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "common/base/result.hpp"

namespace limbcast::gateway {

/// Reads a whole file. kNotFound: there is none; kUnavailable: it cannot be read.
[[nodiscard]] Result<std::string> ReadWholeFile(const std::filesystem::path& path);

/// Walks over the lines of a text; \n and \r\n both end one. The text outlives it.
class LineReader {
 public:
  explicit LineReader(std::string_view text) : rest_(text) {}
  /// The next line without its end; nothing at the end of the text.
  [[nodiscard]] std::optional<std::string_view> Next();
  /// Number of the line that Next gave last, from 1.
  [[nodiscard]] std::size_t number() const { return number_; }

 private:
  std::string_view rest_;
  std::size_t number_ = 0;
};

/// Splits at every `separator` and trims spaces and tabs around each field; `fields` is reused.
void SplitFields(std::string_view line, char separator, std::vector<std::string_view>& fields);

/// A whole field as a number, "nan" and "inf" included; nothing when it is none.
[[nodiscard]] std::optional<double> ParseNumber(std::string_view field);

}  // namespace limbcast::gateway
