#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <functional>

namespace limbcast::bus {

/// The key fields of a value, one after the other, padded with zeros: names one instance of a
/// topic. The byte order is the host's, so it never travels.
struct InstanceKey {
  std::array<std::uint8_t, 16> bytes{};
  bool operator==(const InstanceKey&) const = default;
};

}  // namespace limbcast::bus

template <>
struct std::hash<limbcast::bus::InstanceKey> {
  std::size_t operator()(const limbcast::bus::InstanceKey& key) const noexcept {
    std::uint64_t low = 0;
    std::uint64_t high = 0;
    std::memcpy(&low, key.bytes.data(), 8);
    std::memcpy(&high, key.bytes.data() + 8, 8);
    return std::hash<std::uint64_t>{}(low * 0x9E3779B97F4A7C15ULL ^ high);
  }
};
