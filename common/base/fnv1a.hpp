#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string_view>

namespace limbcast {

/// FNV-1a, 64 bit: the hash of nothing, and a hash continued by bytes.
/// http://www.isthe.com/chongo/tech/comp/fnv/
inline constexpr std::uint64_t kFnv1aBasis = 0xcbf29ce484222325U;

[[nodiscard]] constexpr std::uint64_t Fnv1a(std::uint64_t hash, std::uint8_t byte) {
  return (hash ^ byte) * 0x100000001b3U;
}
[[nodiscard]] constexpr std::uint64_t Fnv1a(std::uint64_t hash, std::span<const std::byte> bytes) {
  for (const std::byte byte : bytes) {
    hash = Fnv1a(hash, static_cast<std::uint8_t>(byte));
  }
  return hash;
}
[[nodiscard]] constexpr std::uint64_t Fnv1a(std::uint64_t hash, std::string_view text) {
  for (const char c : text) {
    hash = Fnv1a(hash, static_cast<std::uint8_t>(c));
  }
  return hash;
}

}  // namespace limbcast
