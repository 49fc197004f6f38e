#pragma once

#include <cstddef>
#include <cstring>

namespace limbcast::filters::lanes {

/// Records of several sensors, number by number: `Record<T>` is a plain struct of nothing but T
/// (flags too), so that Record<Pack> is as many Record<S> interleaved. A block is Record<Pack> seen
/// without naming the pack: the code that fills and reads it need not be compiled for the
/// instruction set that computes with it.

namespace internal {

// With the width known to the compiler, a copy is two instructions for each number.
template <std::size_t kWidth, typename S, std::size_t kNumbers>
inline void Scatter(const std::byte* from, std::byte* to) {
  for (std::size_t i = 0; i < kNumbers; ++i) {
    std::memcpy(to + i * kWidth * sizeof(S), from + i * sizeof(S), sizeof(S));
  }
}
template <std::size_t kWidth, typename S, std::size_t kNumbers>
inline void Gather(const std::byte* from, std::byte* to) {
  for (std::size_t i = 0; i < kNumbers; ++i) {
    std::memcpy(to + i * sizeof(S), from + i * kWidth * sizeof(S), sizeof(S));
  }
}

}  // namespace internal

/// Widths of the blocks there are: numbers in a register of 16 to 64 bytes.
[[nodiscard]] constexpr bool IsBlockWidth(int width) {
  return width == 2 || width == 4 || width == 8;
}

/// @param block  the record of all lanes, `width` of them.
template <typename RecordOfS, typename S>
inline void PutLane(std::byte* block, int width, int lane, const RecordOfS& record) {
  static_assert(sizeof(RecordOfS) % sizeof(S) == 0);
  constexpr std::size_t kNumbers =
      sizeof(RecordOfS) / sizeof(S);  // NOLINT(bugprone-sizeof-expression): a record may be one S
  const auto* from = reinterpret_cast<const std::byte*>(&record);
  std::byte* to = block + static_cast<std::size_t>(lane) * sizeof(S);
  if (width == 4) {
    internal::Scatter<4, S, kNumbers>(from, to);
  } else if (width == 8) {
    internal::Scatter<8, S, kNumbers>(from, to);
  } else {
    internal::Scatter<2, S, kNumbers>(from, to);
  }
}

/// The other way round.
template <typename RecordOfS, typename S>
inline void GetLane(const std::byte* block, int width, int lane, RecordOfS& record) {
  static_assert(sizeof(RecordOfS) % sizeof(S) == 0);
  constexpr std::size_t kNumbers =
      sizeof(RecordOfS) / sizeof(S);  // NOLINT(bugprone-sizeof-expression): a record may be one S
  auto* to = reinterpret_cast<std::byte*>(&record);
  const std::byte* from = block + static_cast<std::size_t>(lane) * sizeof(S);
  if (width == 4) {
    internal::Gather<4, S, kNumbers>(from, to);
  } else if (width == 8) {
    internal::Gather<8, S, kNumbers>(from, to);
  } else {
    internal::Gather<2, S, kNumbers>(from, to);
  }
}

}  // namespace limbcast::filters::lanes
