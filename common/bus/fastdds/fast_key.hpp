#pragma once

#include <fastcdr/Cdr.h>
#include <fastcdr/FastBuffer.h>
#include <fastdds/rtps/common/InstanceHandle.h>

#include <array>
#include <cstring>
#include <exception>

#include "common/bus/wire/codec.hpp"
#include "common/bus/wire/wire_types.hpp"

namespace limbcast::bus::fastdds {

/// An instance handle is the key itself: its fields as big-endian CDR, padded with zeros. That
/// holds because the rules of idl/ keep keys at 16 bytes or less (longer ones would be hashed).
inline constexpr std::size_t kHandle_bytes = 16;

template <typename Wire>
bool HandleOf(const Wire& wire, eprosima::fastrtps::rtps::InstanceHandle_t& handle) {
  std::array<char, kHandle_bytes> key{};
  try {
    eprosima::fastcdr::FastBuffer buffer(key.data(), key.size());
    eprosima::fastcdr::Cdr cdr(buffer, eprosima::fastcdr::Cdr::BIG_ENDIANNESS);
    wire.serializeKey(cdr);
  } catch (const std::exception&) {
    return false;
  }
  eprosima::fastrtps::rtps::octet* bytes = handle.value;
  std::memcpy(bytes, key.data(), key.size());
  return true;
}

/// Sets the key fields of `wire` to what `handle` names; false when it names no instance of T.
template <typename T>
bool KeyOfHandle(const eprosima::fastrtps::rtps::InstanceHandle_t& handle,
                 typename Codec<T>::Wire& wire) {
  std::array<char, kHandle_bytes> key{};
  const eprosima::fastrtps::rtps::octet* bytes = handle.value;
  std::memcpy(key.data(), bytes, key.size());
  try {
    eprosima::fastcdr::FastBuffer buffer(key.data(), key.size());
    eprosima::fastcdr::Cdr cdr(buffer, eprosima::fastcdr::Cdr::BIG_ENDIANNESS);
    Codec<T>::KeyDeserialize(cdr, wire);
    return true;
  } catch (const std::exception&) {
    return false;
  }
}

}  // namespace limbcast::bus::fastdds
