#pragma once

#include <cstddef>
#include <cstring>

namespace limbcast::filters::lanes {

/// Records of several sensors, number by number: `Record<T>` is a plain struct of nothing but T
/// (flags too), so that Record<Pack> is as many Record<S> interleaved. A block is Record<Pack> seen
/// without naming the pack: the code that fills and reads it need not be compiled for the
/// instruction set that computes with it.
///
/// @param block  the record of all lanes, `width` of them.
template <typename RecordOfS, typename S>
inline void PutLane(std::byte* block, int width, int lane, const RecordOfS& record) {
  static_assert(sizeof(RecordOfS) % sizeof(S) == 0);
  constexpr std::size_t kNumbers = sizeof(RecordOfS) / sizeof(S);
  const auto* from = reinterpret_cast<const std::byte*>(&record);
  std::byte* to = block + static_cast<std::size_t>(lane) * sizeof(S);
  const std::size_t stride = static_cast<std::size_t>(width) * sizeof(S);
  for (std::size_t i = 0; i < kNumbers; ++i) {
    std::memcpy(to + i * stride, from + i * sizeof(S), sizeof(S));
  }
}

/// The other way round.
template <typename RecordOfS, typename S>
inline void GetLane(const std::byte* block, int width, int lane, RecordOfS& record) {
  static_assert(sizeof(RecordOfS) % sizeof(S) == 0);
  constexpr std::size_t kNumbers = sizeof(RecordOfS) / sizeof(S);
  auto* to = reinterpret_cast<std::byte*>(&record);
  const std::byte* from = block + static_cast<std::size_t>(lane) * sizeof(S);
  const std::size_t stride = static_cast<std::size_t>(width) * sizeof(S);
  for (std::size_t i = 0; i < kNumbers; ++i) {
    std::memcpy(to + i * sizeof(S), from + i * stride, sizeof(S));
  }
}

}  // namespace limbcast::filters::lanes
