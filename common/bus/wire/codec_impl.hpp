#pragma once

// The bodies of Codec, for the .cpp files that hold a topic's Fields and instantiate its Codec.

#include <fastcdr/Cdr.h>
#include <fastcdr/FastBuffer.h>

#include <exception>
#include <optional>

#include "common/bus/wire/codec.hpp"
#include "common/bus/wire/fields.hpp"

namespace limbcast::bus {

template <typename T>
Status StatusOf(const Misfit& misfit, ErrorCode code) {
  if (misfit.none()) {
    return Ok();
  }
  return Error{code, std::string(Topic<T>::kShortName) + "." + std::string(misfit.field) + " has " +
                         std::to_string(misfit.value) + " " + std::string(misfit.what) +
                         ", at most " + std::to_string(misfit.limit) + " are allowed"};
}

template <typename T>
Status Codec<T>::CheckBounds(const T& value) {
  static const Wire kTypes{};
  FieldChecker checker;
  Fields(checker, value, kTypes);
  return StatusOf<T>(checker.misfit, ErrorCode::kInvalidArgument);
}

template <typename T>
Status Codec<T>::Encode(const T& value, Wire& wire) {
  FieldEncoder encoder;
  Fields(encoder, value, wire);
  return StatusOf<T>(encoder.misfit, ErrorCode::kInvalidArgument);
}

template <typename T>
Status Codec<T>::Decode(const Wire& wire, T& value) {
  FieldDecoder decoder;
  Fields(decoder, value, wire);
  return StatusOf<T>(decoder.misfit, ErrorCode::kCorruptData);
}

template <typename T>
InstanceKey Codec<T>::Key(const T& value) {
  static const Wire kTypes{};
  KeyPacker packer;
  KeyFields(packer, value, kTypes);
  return packer.key;
}

template <typename T>
void Codec<T>::EncodeKey(const T& value, Wire& wire) {
  FieldEncoder encoder;
  KeyFields(encoder, value, wire);
}

template <typename T>
Status Codec<T>::DecodeKey(const Wire& wire, T& value) {
  FieldDecoder decoder;
  KeyFields(decoder, value, wire);
  return StatusOf<T>(decoder.misfit, ErrorCode::kCorruptData);
}

template <typename T>
void Codec<T>::CopyKey(const Wire& from, Wire& to) {
  T key;
  FieldDecoder decoder;
  KeyFields(decoder, key, from);
  EncodeKey(key, to);
}

template <typename T>
void Codec<T>::KeyDeserialize(eprosima::fastcdr::Cdr& cdr, Wire& wire) {
  static const T kTypes{};
  KeyReader reader(cdr);
  KeyFields(reader, kTypes, wire);
}

inline constexpr std::size_t kEncapsulation_bytes = 4;

/// Runs `read(cdr)` over encapsulated CDR. Nothing when the header is not XCDR1 or it throws, else
/// how many bytes are left.
template <typename Read>
std::optional<std::size_t> ReadEncapsulated(std::span<const char> bytes, Read read) {
  if (bytes.size() < kEncapsulation_bytes || bytes[0] != 0 || (bytes[1] != 0 && bytes[1] != 1)) {
    return std::nullopt;
  }
  try {
    // Fast CDR has no read-only buffer; reading does not write.
    eprosima::fastcdr::FastBuffer buffer(const_cast<char*>(bytes.data()), bytes.size());
    eprosima::fastcdr::Cdr cdr(buffer, eprosima::fastcdr::Cdr::DEFAULT_ENDIAN,
                               eprosima::fastcdr::Cdr::DDS_CDR);
    cdr.read_encapsulation();
    read(cdr);
    return bytes.size() - cdr.getSerializedDataLength();
  } catch (const std::exception&) {
    return std::nullopt;
  }
}

/// Up to 3 bytes of padding may follow; more means another type.
inline bool OnlyPaddingIn(std::optional<std::size_t> left) { return left && *left < 4; }

template <typename Write>
std::size_t WriteEncapsulated(std::span<char> out, Write write) {
  try {
    eprosima::fastcdr::FastBuffer buffer(out.data(), out.size());
    eprosima::fastcdr::Cdr cdr(buffer, eprosima::fastcdr::Cdr::DEFAULT_ENDIAN,
                               eprosima::fastcdr::Cdr::DDS_CDR);
    cdr.serialize_encapsulation();
    write(cdr);
    return cdr.getSerializedDataLength();
  } catch (const std::exception&) {
    return 0;
  }
}

template <typename T>
std::size_t Codec<T>::SerializedSize(const Wire& wire) {
  return kEncapsulation_bytes + Wire::getCdrSerializedSize(wire);
}

template <typename T>
std::size_t Codec<T>::Serialize(const Wire& wire, std::span<char> out) {
  return WriteEncapsulated(out, [&](eprosima::fastcdr::Cdr& cdr) { wire.serialize(cdr); });
}

template <typename T>
bool Codec<T>::Deserialize(std::span<const char> bytes, Wire& wire) {
  std::size_t used = 0;
  const auto left = ReadEncapsulated(bytes, [&](eprosima::fastcdr::Cdr& cdr) {
    wire.deserialize(cdr);
    used = cdr.getSerializedDataLength();
  });
  if constexpr (WireType<T>::kHasText) {
    // The generated code cuts long texts silently. Then the value is shorter than its bytes.
    return OnlyPaddingIn(left) && SerializedSize(wire) == used;
  }
  return OnlyPaddingIn(left);
}

template <typename T>
std::size_t Codec<T>::SerializeKey(const Wire& wire, std::span<char> out) {
  return WriteEncapsulated(out, [&](eprosima::fastcdr::Cdr& cdr) { wire.serializeKey(cdr); });
}

template <typename T>
bool Codec<T>::DeserializeKey(std::span<const char> bytes, Wire& wire) {
  return bytes.size() <= kMaxKeyCdr_bytes && DeserializeLeadingKey(bytes, wire);
}

template <typename T>
bool Codec<T>::DeserializeLeadingKey(std::span<const char> bytes, Wire& wire) {
  return ReadEncapsulated(bytes, [&](eprosima::fastcdr::Cdr& cdr) { KeyDeserialize(cdr, wire); })
      .has_value();
}

template <typename T>
KeyHash Codec<T>::HashKey(const Wire& wire) {
  KeyHash hash{};
  std::array<char, 16> bytes{};
  eprosima::fastcdr::FastBuffer buffer(bytes.data(), bytes.size());
  eprosima::fastcdr::Cdr cdr(buffer, eprosima::fastcdr::Cdr::BIG_ENDIANNESS);
  wire.serializeKey(cdr);
  std::memcpy(hash.data(), bytes.data(), bytes.size());
  return hash;
}

template <typename T>
void Codec<T>::FromKeyHash(const KeyHash& hash, Wire& wire) {
  std::array<char, 16> bytes{};
  std::memcpy(bytes.data(), hash.data(), bytes.size());
  eprosima::fastcdr::FastBuffer buffer(bytes.data(), bytes.size());
  eprosima::fastcdr::Cdr cdr(buffer, eprosima::fastcdr::Cdr::BIG_ENDIANNESS);
  KeyDeserialize(cdr, wire);
}

}  // namespace limbcast::bus
