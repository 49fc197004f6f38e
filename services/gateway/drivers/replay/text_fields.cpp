#include "services/gateway/drivers/replay/text_fields.hpp"

#include <charconv>
#include <fstream>
#include <iterator>
#include <system_error>

namespace limbcast::gateway {

namespace {

std::string_view Trim(std::string_view field) {
  constexpr std::string_view kBlank = " \t\r";
  const std::size_t begin = field.find_first_not_of(kBlank);
  if (begin == std::string_view::npos) {
    return {};
  }
  return field.substr(begin, field.find_last_not_of(kBlank) - begin + 1);
}

}  // namespace

Result<std::string> ReadWholeFile(const std::filesystem::path& path) {
  std::error_code error;
  if (!std::filesystem::exists(path, error)) {
    return Error{ErrorCode::kNotFound, "no such file: " + path.string()};
  }
  std::ifstream file(path, std::ios::binary);
  std::string text{std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
  if (!file.is_open() || file.bad()) {
    return Error{ErrorCode::kUnavailable, "cannot read " + path.string()};
  }
  return text;
}

std::optional<std::string_view> LineReader::Next() {
  if (rest_.empty()) {
    return std::nullopt;
  }
  ++number_;
  const std::size_t end = rest_.find('\n');
  std::string_view line = rest_.substr(0, end);
  rest_ = end == std::string_view::npos ? std::string_view{} : rest_.substr(end + 1);
  if (line.ends_with('\r')) {
    line.remove_suffix(1);
  }
  return line;
}

void SplitFields(std::string_view line, char separator, std::vector<std::string_view>& fields) {
  fields.clear();
  while (true) {
    const std::size_t end = line.find(separator);
    fields.push_back(Trim(line.substr(0, end)));
    if (end == std::string_view::npos) {
      return;
    }
    line.remove_prefix(end + 1);
  }
}

std::optional<double> ParseNumber(std::string_view field) {
  if (field.starts_with('+')) {
    field.remove_prefix(1);
  }
  double value = 0.0;
  const auto [end, error] = std::from_chars(field.data(), field.data() + field.size(), value);
  if (error != std::errc{} || end != field.data() + field.size()) {
    return std::nullopt;
  }
  return value;
}

}  // namespace limbcast::gateway
