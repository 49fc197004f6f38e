#pragma once

#include <cstddef>
#include <span>
#include <string_view>
#include <vector>

#include "common/base/result.hpp"
#include "common/bus/topics.hpp"

namespace limbcast::bus {

// Domain values as the bytes that travel (CDR with its 4-byte header), for recordings. Instantiated
// for every type of AllTopics. Thread-safe.

/// Puts `value` into `bytes`, whose capacity is reused. Fails with kInvalidArgument, naming the
/// field, when a bound of the wire type is exceeded.
template <typename T>
[[nodiscard]] Status EncodeCdr(const T& value, std::vector<std::byte>& bytes);

/// Fails with kCorruptData when `bytes` are not one whole value of T; `value` means nothing then.
template <typename T>
[[nodiscard]] Status DecodeCdr(std::span<const std::byte> bytes, T& value);

/// Name of the wire type, e.g. "limbcast::wire::MargSample". Static storage.
template <typename T>
[[nodiscard]] std::string_view WireTypeName();

}  // namespace limbcast::bus
