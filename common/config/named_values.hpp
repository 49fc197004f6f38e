#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "common/config/config_file.hpp"

namespace limbcast::config {

/// A name that `parse` (text → std::optional<T>) knows. One that it does not know is refused: "must
/// be <what>, is 'x'". `fallback` then, and when the key is not there or empty.
template <typename T, typename Parse>
[[nodiscard]] T ReadNamed(const Section& section, std::string_view key, T fallback, Parse parse,
                          std::string_view what) {
  constexpr std::size_t kMaxName = 64;
  const std::string name = section.Read(key, "", kMaxName);
  if (name.empty()) {
    return fallback;
  }
  if (auto value = parse(name)) {
    return *std::move(value);
  }
  section.Fail(key, "must be " + std::string(what) + ", is '" + name + "'");
  return fallback;
}

/// A list of names, each of which `parse` (text → std::optional<T>) knows. One that it does not
/// know is refused: "must be <what>, has 'x'". `fallback` when the key is not there.
template <typename T, typename Parse>
[[nodiscard]] std::vector<T> ReadNamedList(const Section& section, std::string_view key,
                                           std::vector<T> fallback, Parse parse,
                                           std::string_view what) {
  if (!section.Has(key)) {
    return fallback;
  }
  std::vector<T> values;
  for (const std::string& name : section.Read(key, std::vector<std::string>())) {
    if (auto value = parse(name)) {
      values.push_back(*std::move(value));
    } else {
      section.Fail(key, "must be " + std::string(what) + ", has '" + name + "'");
    }
  }
  return values;
}

}  // namespace limbcast::config
