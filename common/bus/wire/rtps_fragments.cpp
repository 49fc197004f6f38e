#include "common/bus/wire/rtps_fragments.hpp"

#include <algorithm>
#include <array>

namespace limbcast::bus {
namespace {

// DDSI-RTPS 2.2, table 9.3 and 9.4.5: header, submessages, their flags.
constexpr std::array<std::uint8_t, 4> kProtocol = {'R', 'T', 'P', 'S'};
constexpr std::size_t kHeader_bytes = 20;
constexpr std::size_t kSubmessageHeader_bytes = 4;
constexpr std::uint8_t kPad = 0x01;
constexpr std::uint8_t kInfoTimestamp = 0x09;
constexpr std::uint8_t kDataFragment = 0x16;
constexpr std::uint8_t kLittleEndian = 0x01;
constexpr std::uint8_t kInlineQos = 0x02;
// 9.4.5.4: the inline QoS begins this far behind the field that says so, or later.
constexpr std::size_t kOctetsToInlineQosAt = 2;
constexpr std::size_t kOctetsToInlineQos = 28;
// 9.6.2.2.2, table 9.12: parameters.
constexpr std::uint8_t kParameterPad = 0x00;  // either half of 0x0000
constexpr std::uint16_t kParameterSentinel = 0x0001;
constexpr std::uint16_t kParameterKeyHash = 0x0070;
constexpr std::size_t kParameterHeader_bytes = 4;

constexpr std::size_t Aligned(std::size_t size) { return (size + 3) & ~std::size_t{3}; }

std::uint16_t Read16(std::span<const std::uint8_t> bytes, std::size_t at, bool little_endian) {
  const unsigned first = bytes[at];
  const unsigned second = bytes[at + 1];
  return static_cast<std::uint16_t>(little_endian ? first | (second << 8U)
                                                  : (first << 8U) | second);
}

// `fragment`: the body of a DATA_FRAG submessage. False when its parameters do not end within it.
bool ForgetKeys(std::span<std::uint8_t> fragment, bool little_endian) {
  if (fragment.size() < kOctetsToInlineQosAt + 2) {
    return false;
  }
  const std::size_t octets = Read16(fragment, kOctetsToInlineQosAt, little_endian);
  std::size_t at = kOctetsToInlineQosAt + 2 + std::max(octets, kOctetsToInlineQos);
  while (at + kParameterHeader_bytes <= fragment.size()) {
    const std::uint16_t parameter = Read16(fragment, at, little_endian);
    if (parameter == kParameterSentinel) {
      return true;
    }
    if (parameter == kParameterKeyHash) {
      fragment[at] = fragment[at + 1] = kParameterPad;
    }
    at += Aligned(kParameterHeader_bytes + Read16(fragment, at + 2, little_endian));
  }
  return false;
}

}  // namespace

bool ForgetKeysOfFragments(std::span<std::uint8_t> message) {
  if (message.size() < kHeader_bytes ||
      !std::equal(kProtocol.begin(), kProtocol.end(), message.begin())) {
    return true;
  }
  std::size_t at = kHeader_bytes;
  while (at + kSubmessageHeader_bytes <= message.size()) {
    const std::uint8_t kind = message[at];
    const std::uint8_t flags = message[at + 1];
    const bool little_endian = (flags & kLittleEndian) != 0;
    std::size_t length = Read16(message, at + 2, little_endian);
    at += kSubmessageHeader_bytes;
    // 9.4.5.1.3: a length of 0 is "to the end", but for these two, which may be empty.
    if (length == 0 && kind != kPad && kind != kInfoTimestamp) {
      length = message.size() - at;
    }
    if (at + length > message.size()) {
      break;  // the library reads no further either
    }
    if (kind == kDataFragment && (flags & kInlineQos) != 0 &&
        !ForgetKeys(message.subspan(at, length), little_endian)) {
      return false;
    }
    at += Aligned(length);
  }
  return true;
}

}  // namespace limbcast::bus
