#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "common/config/config_file.hpp"

namespace limbcast::config {

inline constexpr std::size_t kMaxName = 64;

/// A name that `parse` (text → std::optional<T>) knows. One that it does not know is refused: "must
/// be <what>, is 'x'". `fallback` then, and when the key is not there.
template <typename T, typename Parse>
[[nodiscard]] T ReadNamed(const Section& section, std::string_view key, T fallback, Parse parse,
                          std::string_view what) {
  if (!section.Has(key)) {
    return fallback;
  }
  const std::string name = section.Read(key, "", kMaxName);
  if (auto value = parse(name)) {
    return *std::move(value);
  }
  section.Fail(key, "must be " + std::string(what) + ", is '" + name + "'");
  return fallback;
}

/// As ReadNamed, where an empty name is as good as none: `fallback`, too.
template <typename T, typename Parse>
[[nodiscard]] std::optional<T> ReadNamedIfAny(const Section& section, std::string_view key,
                                              std::optional<T> fallback, Parse parse,
                                              std::string_view what) {
  const bool any = !section.Read(key, "", kMaxName).empty();
  return any ? ReadNamed(section, key, std::move(fallback), std::move(parse), what) : fallback;
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
