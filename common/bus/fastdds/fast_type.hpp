#pragma once

#include <cstdint>
#include <cstring>
#include <fastdds/dds/topic/TopicDataType.hpp>
#include <functional>

#include "common/bus/wire/codec.hpp"
#include "common/bus/wire/wire_types.hpp"

namespace limbcast::bus::fastdds {

/// What travels through Fast DDS: the wire struct, and whether the bytes it was read from were bad.
template <typename T>
struct FastSample {
  typename Codec<T>::Wire wire;
  bool malformed = false;
};

/// The instance that samples without a readable key are filed under: no key of the project is all
/// ones.
inline constexpr std::uint8_t kMalformedHandleByte = 0xFF;

/// An instance handle is the key itself, because no key of the project is long enough to be hashed.
inline void SetHandle(const KeyHash& key, eprosima::fastrtps::rtps::InstanceHandle_t& handle) {
  eprosima::fastrtps::rtps::octet* bytes = handle.value;
  std::memcpy(bytes, key.data(), key.size());
}
inline KeyHash KeyOf(const eprosima::fastrtps::rtps::InstanceHandle_t& handle) {
  KeyHash key{};
  const eprosima::fastrtps::rtps::octet* bytes = handle.value;
  std::memcpy(key.data(), bytes, key.size());
  return key;
}

/// How Fast DDS handles the wire type of T: keys on the stack, malformed bytes marked. Thread-safe.
///
/// It replaces the generated type support, which keeps the key buffer in the type object although
/// all writers and readers of a participant share that object: two writing threads then send
/// samples under each other's instances.
template <typename T>
class FastType final : public eprosima::fastdds::dds::TopicDataType {
 public:
  using Sample = FastSample<T>;
  using Wire = typename Codec<T>::Wire;
  using Payload = eprosima::fastrtps::rtps::SerializedPayload_t;
  using Handle = eprosima::fastrtps::rtps::InstanceHandle_t;

  FastType() {
    setName(Codec<T>::kTypeName);
    constexpr std::uint32_t kEncapsulation_bytes = 4;
    const auto body_bytes = static_cast<std::uint32_t>(Wire::getMaxCdrSerializedSize());
    m_typeSize = ((body_bytes + 3U) & ~3U) + kEncapsulation_bytes;
    m_isGetKeyDefined = true;
    // Readers match by topic and type name alone, as those of Cyclone DDS do.
    auto_fill_type_object(false);
    auto_fill_type_information(false);
  }

  bool serialize(void* data, Payload* payload) override {
    const std::size_t used =
        Codec<T>::Serialize(static_cast<const Sample*>(data)->wire,
                            {reinterpret_cast<char*>(payload->data), payload->max_size});
    payload->encapsulation =
        eprosima::fastrtps::rtps::DEFAULT_ENDIAN == eprosima::fastrtps::rtps::LITTLEEND ? CDR_LE
                                                                                        : CDR_BE;
    payload->length = static_cast<std::uint32_t>(used);
    return used != 0;
  }

  /// Always succeeds: Fast DDS ignores a refusal in one place (it then files the sample under the
  /// key of the one before) and drops it without a word in the other. The reader looks at
  /// `malformed` and counts.
  bool deserialize(Payload* payload, void* data) override {
    auto& sample = *static_cast<Sample*>(data);
    sample.malformed = !Codec<T>::Deserialize(
        {reinterpret_cast<const char*>(payload->data), payload->length}, sample.wire);
    return true;
  }

  std::function<std::uint32_t()> getSerializedSizeProvider(void* data) override {
    return [data] {
      return static_cast<std::uint32_t>(
          Codec<T>::SerializedSize(static_cast<const Sample*>(data)->wire));
    };
  }

  void* createData() override { return new Sample(); }
  void deleteData(void* data) override { delete static_cast<Sample*>(data); }
  /// Not said to be bounded although it is: Fast DDS would drop what is too long without a word.
  bool is_bounded() const override { return false; }

  bool getKey(void* data, Handle* handle, bool /*force_md5*/) override {
    const auto& sample = *static_cast<const Sample*>(data);
    KeyHash key{};
    if (sample.malformed) {
      key.fill(kMalformedHandleByte);
    } else {
      key = Codec<T>::HashKey(sample.wire);
    }
    SetHandle(key, *handle);
    return true;
  }
};

}  // namespace limbcast::bus::fastdds
