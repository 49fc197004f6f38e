#pragma once

#include <array>
#include <charconv>
#include <cstddef>
#include <span>
#include <string>
#include <string_view>
#include <utility>

#include "common/base/result.hpp"

namespace limbcast::filters {

/// One field of a configuration struct: its name, how to read and write it, and what it may be.
/// A filter's table of these serves both Validate and the settings of MakeFilter.
template <typename Config>
struct SettingField {
  std::string_view name;
  double (*get)(const Config&) = nullptr;
  void (*set)(Config&, double) = nullptr;
  double min = 0.0;
  double max = 0.0;
  bool min_excluded = false;
  bool whole = false;                           ///< whole numbers only
  std::span<const std::string_view> choices{};  ///< names of the values 0, 1, ...; empty = a number
};

namespace internal {

template <typename T>
struct MemberOf;
template <typename Config, typename Value>
struct MemberOf<Value Config::*> {
  using ConfigType = Config;
  using ValueType = Value;
};

template <auto kMember>
using ConfigOf = typename MemberOf<decltype(kMember)>::ConfigType;

template <auto kMember>
double Get(const ConfigOf<kMember>& config) {
  return static_cast<double>(config.*kMember);
}
template <auto kMember>
void Set(ConfigOf<kMember>& config, double value) {
  config.*kMember = static_cast<typename MemberOf<decltype(kMember)>::ValueType>(value);
}

inline constexpr std::array<std::string_view, 2> kBoolNames = {"false", "true"};

[[nodiscard]] std::string RangeText(double min, double max, bool min_excluded, bool whole);
[[nodiscard]] std::string ChoicesText(std::span<const std::string_view> choices);
[[nodiscard]] std::string NumberText(double value);

}  // namespace internal

/// A number in [min, max], or in (min, max] with `min_excluded`.
template <auto kMember>
constexpr SettingField<internal::ConfigOf<kMember>> Number(std::string_view name, double min,
                                                           double max, bool min_excluded = false) {
  return {name, &internal::Get<kMember>, &internal::Set<kMember>, min, max, min_excluded, false,
          {}};
}
template <auto kMember>
constexpr SettingField<internal::ConfigOf<kMember>> Whole(std::string_view name, double min,
                                                          double max) {
  return {name, &internal::Get<kMember>, &internal::Set<kMember>, min, max, false, true, {}};
}
/// An enum by the names of its values 0, 1, ...
template <auto kMember>
constexpr SettingField<internal::ConfigOf<kMember>> Choice(
    std::string_view name, std::span<const std::string_view> choices) {
  return {name,
          &internal::Get<kMember>,
          &internal::Set<kMember>,
          0.0,
          static_cast<double>(choices.size()) - 1.0,
          false,
          true,
          choices};
}
template <auto kMember>
constexpr SettingField<internal::ConfigOf<kMember>> Flag(std::string_view name) {
  return Choice<kMember>(name, internal::kBoolNames);
}

/// The first field out of its range; `owner` is the filter's name.
template <typename Config>
[[nodiscard]] Status ValidateFields(std::string_view owner, const Config& config,
                                    std::span<const SettingField<Config>> fields) {
  for (const auto& field : fields) {
    const double value = field.get(config);
    const bool above = field.min_excluded ? value > field.min : value >= field.min;
    if (!above || !(value <= field.max)) {
      return Error{ErrorCode::kInvalidArgument,
                   std::string(owner) + "." + std::string(field.name) + " must be " +
                       internal::RangeText(field.min, field.max, field.min_excluded, field.whole) +
                       ", is " + internal::NumberText(value)};
    }
  }
  return Ok();
}

/// Sets one field from text. Fails when the text is not such a value; ranges are for
/// ValidateFields.
template <typename Config>
[[nodiscard]] Status SetField(std::string_view owner, Config& config,
                              const SettingField<Config>& field, std::string_view text) {
  const std::string place = std::string(owner) + "." + std::string(field.name);
  if (!field.choices.empty()) {
    for (std::size_t i = 0; i < field.choices.size(); ++i) {
      if (text == field.choices[i]) {
        field.set(config, static_cast<double>(i));
        return Ok();
      }
    }
    return Error{ErrorCode::kInvalidArgument, place + " must be " +
                                                  internal::ChoicesText(field.choices) + ", is '" +
                                                  std::string(text) + "'"};
  }
  double value = 0.0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || end != text.data() + text.size() ||
      (field.whole && value != static_cast<double>(static_cast<long>(value)))) {
    return Error{ErrorCode::kInvalidArgument,
                 place + " must be " +
                     internal::RangeText(field.min, field.max, field.min_excluded, field.whole) +
                     ", is '" + std::string(text) + "'"};
  }
  field.set(config, value);
  return Ok();
}

/// The defaults of `Config` changed by settings, checked.
template <typename Config>
[[nodiscard]] Result<Config> ConfigFromSettings(
    std::string_view owner, std::span<const SettingField<Config>> fields,
    std::span<const std::pair<std::string, std::string>> settings, Config config = {}) {
  for (const auto& [key, text] : settings) {
    const SettingField<Config>* found = nullptr;
    std::string known;
    for (const auto& field : fields) {
      found = field.name == key ? &field : found;
      known += (known.empty() ? "" : ", ") + std::string(field.name);
    }
    if (found == nullptr) {
      return Error{ErrorCode::kInvalidArgument, std::string("filter ")
                                                    .append(owner)
                                                    .append(" has no setting '")
                                                    .append(key)
                                                    .append("', it has ")
                                                    .append(known)};
    }
    if (Status set = SetField(owner, config, *found, text); !set) {
      return set.error();
    }
  }
  if (Status valid = ValidateFields(owner, config, fields); !valid) {
    return valid.error();
  }
  return config;
}

}  // namespace limbcast::filters
