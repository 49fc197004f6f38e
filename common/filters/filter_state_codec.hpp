#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <span>
#include <string_view>

#include "common/base/expects.hpp"
#include "common/base/result.hpp"

namespace limbcast::filters {

/// Saved filter states: a header (magic, filter name, version, size, checksum) and the bytes of the
/// state struct. For the same build on the same machine type; other builds refuse by version or
/// size. `State` must hold no pointers.
struct SavedStateHeader {
  std::array<char, 8> magic{};
  std::array<char, 16> filter{};
  std::uint32_t version = 0;
  std::uint32_t size_bytes = 0;
  std::uint64_t checksum = 0;  // FNV-1a over the state's bytes
};

[[nodiscard]] SavedStateHeader MakeStateHeader(std::string_view filter, std::uint32_t version,
                                               std::span<const std::byte> state);
[[nodiscard]] Status CheckStateHeader(std::string_view filter, std::uint32_t version,
                                      std::size_t state_size_bytes, std::span<const std::byte> in);

template <typename State>
[[nodiscard]] constexpr std::size_t SavedStateSize_bytes() {
  return sizeof(SavedStateHeader) + sizeof(State);
}

template <typename State>
void WriteState(std::string_view filter, std::uint32_t version, const State& state,
                std::span<std::byte> out) {
  Expects(out.size() == SavedStateSize_bytes<State>(), "a buffer of state_size_bytes()");
  const auto body = out.subspan(sizeof(SavedStateHeader));
  std::memcpy(body.data(), static_cast<const void*>(&state), sizeof(State));
  const SavedStateHeader header = MakeStateHeader(filter, version, body);
  std::memcpy(out.data(), &header, sizeof header);
}

template <typename State>
[[nodiscard]] Status ReadState(std::string_view filter, std::uint32_t version,
                               std::span<const std::byte> in, State& state) {
  if (Status checked = CheckStateHeader(filter, version, sizeof(State), in); !checked) {
    return checked;
  }
  std::memcpy(static_cast<void*>(&state), in.data() + sizeof(SavedStateHeader), sizeof(State));
  return Ok();
}

}  // namespace limbcast::filters
