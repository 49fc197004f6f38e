#pragma once

#include <cstddef>
#include <span>

#include "common/bus/wire/codec.hpp"
#include "common/bus/wire/wire_types.hpp"

namespace limbcast::bus::cyclone {

/// What the sertype needs to know of one wire type, without being a template itself. `wire` points
/// to that type. Thread-safe.
struct WireOps {
  const char* type_name;
  /// With encapsulation, unpadded.
  std::size_t (*serialized_size)(const void* wire);
  std::size_t (*serialize)(const void* wire, std::span<char> out);
  bool (*deserialize)(std::span<const char> bytes, void* wire);
  std::size_t (*serialize_key)(const void* wire, std::span<char> out);
  KeyHash (*hash_key)(const void* wire);
  /// Key of a whole sample or of a key-only one; false when the bytes do not hold one. Allocates
  /// nothing.
  bool (*read_key)(std::span<const char> bytes, bool key_only, KeyHash& key);
  /// Key-only CDR of a key; the size used.
  std::size_t (*serialize_key_hash)(const KeyHash& key, std::span<char> out);
};

template <typename T>
const WireOps& WireOpsOf() {
  using C = Codec<T>;
  using Wire = typename C::Wire;
  static const WireOps ops = {
      .type_name = C::kTypeName,
      .serialized_size =
          [](const void* wire) { return C::SerializedSize(*static_cast<const Wire*>(wire)); },
      .serialize =
          [](const void* wire, std::span<char> out) {
            return C::Serialize(*static_cast<const Wire*>(wire), out);
          },
      .deserialize = [](std::span<const char> bytes,
                        void* wire) { return C::Deserialize(bytes, *static_cast<Wire*>(wire)); },
      .serialize_key =
          [](const void* wire, std::span<char> out) {
            return C::SerializeKey(*static_cast<const Wire*>(wire), out);
          },
      .hash_key = [](const void* wire) { return C::HashKey(*static_cast<const Wire*>(wire)); },
      .read_key =
          [](std::span<const char> bytes, bool key_only, KeyHash& key) {
            thread_local Wire wire;
            if (!(key_only ? C::DeserializeKey(bytes, wire)
                           : C::DeserializeLeadingKey(bytes, wire))) {
              return false;
            }
            key = C::HashKey(wire);
            return true;
          },
      .serialize_key_hash =
          [](const KeyHash& key, std::span<char> out) {
            thread_local Wire wire;
            C::FromKeyHash(key, wire);
            return C::SerializeKey(wire, out);
          },
  };
  return ops;
}

}  // namespace limbcast::bus::cyclone
