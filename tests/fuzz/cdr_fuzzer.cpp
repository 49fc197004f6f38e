// Every topic's decoder, and what looks into whole RTPS messages, on bytes that nobody meant: what
// a hostile or broken peer may send. The first byte picks which. What is decoded must survive being
// encoded and decoded again.
#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <iterator>
#include <span>
#include <tuple>
#include <utility>
#include <vector>

#include "common/bus/cdr.hpp"
#include "common/bus/wire/rtps_fragments.hpp"

namespace {

using limbcast::bus::AllTopics;

template <typename T>
void DecodeTwice(std::span<const std::byte> bytes) {
  T value;
  if (!limbcast::bus::DecodeCdr(bytes, value).ok()) {
    return;
  }
  std::vector<std::byte> again;
  T same;
  if (!limbcast::bus::EncodeCdr(value, again).ok() ||
      !limbcast::bus::DecodeCdr<T>(again, same).ok()) {
    std::abort();  // a value came in that could not go out
  }
}

void ForgetTwice(std::span<const std::byte> bytes) {
  std::vector<std::uint8_t> message;
  std::ranges::transform(bytes, std::back_inserter(message),
                         [](std::byte byte) { return std::to_integer<std::uint8_t>(byte); });
  if (limbcast::bus::ForgetKeysOfFragments(message)) {
    const std::vector<std::uint8_t> once = message;
    if (!limbcast::bus::ForgetKeysOfFragments(message) || message != once) {
      std::abort();  // a key was left
    }
  }
}

using Decode = void (*)(std::span<const std::byte>);

template <std::size_t... I>
constexpr std::array<Decode, sizeof...(I) + 1> Decoders(std::index_sequence<I...>) {
  return {&DecodeTwice<std::tuple_element_t<I, AllTopics>>..., &ForgetTwice};
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static constexpr auto kDecoders =
      Decoders(std::make_index_sequence<std::tuple_size_v<AllTopics>>());
  if (size > 0) {
    kDecoders[data[0] % kDecoders.size()](std::as_bytes(std::span(data + 1, size - 1)));
  }
  return 0;
}
