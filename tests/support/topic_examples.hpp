#pragma once

#include <cstdint>
#include <string>

#include "common/bus/topics.hpp"

namespace limbcast::test_support {

/// A value of T that depends on nothing but its arguments: every field set, within its bounds, and
/// lists and texts filled to varying lengths. `key` (0 to 2000) picks the instance, `sequence`
/// (from 1) counts within it; a receiver reads both back and can then tell whether the rest arrived
/// intact.
template <typename T>
[[nodiscard]] T Example(std::uint32_t key, std::uint32_t sequence);

/// The `key` an Example was made with; reads key fields only.
template <typename T>
[[nodiscard]] std::uint32_t ExampleKey(const T& value);

/// The `sequence` an Example was made with.
template <typename T>
[[nodiscard]] std::uint32_t ExampleSequence(const T& value);

/// The bytes that travel for `value`: equal bytes are equal values, to the last bit.
template <typename T>
[[nodiscard]] std::string WireBytes(const T& value);

/// `value` is what Example makes of its key and sequence.
template <typename T>
[[nodiscard]] bool IsIntact(const T& value) {
  return WireBytes(value) == WireBytes(Example<T>(ExampleKey(value), ExampleSequence(value)));
}

}  // namespace limbcast::test_support
