#pragma once

#include <fastcdr/Cdr.h>
#include <fastcdr/FastBuffer.h>

#include <cstdint>
#include <cstring>
#include <exception>
#include <fastdds/dds/topic/TopicDataType.hpp>
#include <functional>
#include <string>
#include <string_view>

#include "common/bus/fastdds/fast_key.hpp"

namespace limbcast::bus::fastdds {

/// What travels through Fast DDS: the wire struct, and whether the bytes it was read from were bad.
template <typename Wire>
struct FastSample {
  Wire wire;
  bool malformed = false;
};

/// The instance that samples without a readable key are filed under. Keys of the project are short,
/// so their handles end in zeros and never look like this one.
inline constexpr std::uint8_t kMalformedHandleByte = 0xFF;

/// How Fast DDS handles a Wire (any struct of fastddsgen 2.3): keys on the stack, malformed bytes
/// marked. Thread-safe.
///
/// It replaces the generated type support, which keeps the key buffer in the type object although
/// all writers and readers of a participant share that object: two writing threads then send
/// samples under each other's instances.
template <typename Wire>
class FastType final : public eprosima::fastdds::dds::TopicDataType {
 public:
  using Sample = FastSample<Wire>;
  using Payload = eprosima::fastrtps::rtps::SerializedPayload_t;
  using Handle = eprosima::fastrtps::rtps::InstanceHandle_t;

  explicit FastType(std::string_view type_name) {
    setName(std::string(type_name).c_str());
    const auto body_bytes = static_cast<std::uint32_t>(Wire::getMaxCdrSerializedSize());
    m_typeSize = ((body_bytes + 3U) & ~3U) + kEncapsulation_bytes;
    m_isGetKeyDefined = Wire::isKeyDefined();
    // Readers match by topic and type name alone, as those of Cyclone DDS do.
    auto_fill_type_object(false);
    auto_fill_type_information(false);
  }

  bool serialize(void* data, Payload* payload) override {
    try {
      eprosima::fastcdr::FastBuffer buffer(reinterpret_cast<char*>(payload->data),
                                           payload->max_size);
      eprosima::fastcdr::Cdr cdr(buffer, eprosima::fastcdr::Cdr::DEFAULT_ENDIAN,
                                 eprosima::fastcdr::Cdr::DDS_CDR);
      payload->encapsulation =
          cdr.endianness() == eprosima::fastcdr::Cdr::BIG_ENDIANNESS ? CDR_BE : CDR_LE;
      cdr.serialize_encapsulation();
      static_cast<const Sample*>(data)->wire.serialize(cdr);
      payload->length = static_cast<std::uint32_t>(cdr.getSerializedDataLength());
      return true;
    } catch (const std::exception&) {
      return false;  // does not fit: the writer reports it
    }
  }

  /// Always succeeds: Fast DDS ignores a refusal in one place (it then files the sample under the
  /// key of the one before) and drops it without a word in the other. The reader looks at
  /// `malformed` and counts.
  bool deserialize(Payload* payload, void* data) override {
    auto& sample = *static_cast<Sample*>(data);
    sample.malformed = !Read(*payload, sample.wire);
    return true;
  }

  std::function<std::uint32_t()> getSerializedSizeProvider(void* data) override {
    return [data] {
      return static_cast<std::uint32_t>(
                 Wire::getCdrSerializedSize(static_cast<const Sample*>(data)->wire)) +
             kEncapsulation_bytes;
    };
  }

  void* createData() override { return new Sample(); }
  void deleteData(void* data) override { delete static_cast<Sample*>(data); }
  bool is_bounded() const override { return true; }

  bool getKey(void* data, Handle* handle, bool /*force_md5*/) override {
    const auto& sample = *static_cast<const Sample*>(data);
    if (sample.malformed) {
      eprosima::fastrtps::rtps::octet* bytes = handle->value;
      std::memset(bytes, kMalformedHandleByte, kHandle_bytes);
      return true;
    }
    return HandleOf(sample.wire, *handle);
  }

 private:
  static constexpr std::uint32_t kEncapsulation_bytes = 4;

  static bool Read(const Payload& payload, Wire& wire) {
    // Plain CDR of either byte order; anything else (parameter lists, XCDR2) is not this type.
    if (payload.length < kEncapsulation_bytes || payload.data[0] != 0 || payload.data[1] > 1) {
      return false;
    }
    try {
      eprosima::fastcdr::FastBuffer buffer(reinterpret_cast<char*>(payload.data), payload.length);
      eprosima::fastcdr::Cdr cdr(buffer, eprosima::fastcdr::Cdr::DEFAULT_ENDIAN,
                                 eprosima::fastcdr::Cdr::DDS_CDR);
      cdr.read_encapsulation();
      wire.deserialize(cdr);
      // The sender pads to four bytes; more left over means another type.
      return payload.length - cdr.getSerializedDataLength() < kEncapsulation_bytes;
    } catch (const std::exception&) {
      return false;  // too short, a length beyond its bound, or no memory for one
    }
  }
};

}  // namespace limbcast::bus::fastdds
